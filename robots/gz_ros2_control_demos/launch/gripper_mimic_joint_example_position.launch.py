"""A gripper whose left finger mimics the right one, commanded by a position in m."""

from launch_py import IncludeLaunchDescription, LaunchDescription
from launch_py.launch_description_sources import PythonLaunchDescriptionSource
from launch_py.ros import FindPackageShare
from launch_py.substitutions import PathJoinSubstitution


def generate_launch_description() -> LaunchDescription:
    """Return the gripper with this interface."""
    share = FindPackageShare("gz_ros2_control_demos")
    gripper = PathJoinSubstitution([share, "launch", "gripper_mimic_joint_example.launch.py"])
    return LaunchDescription(
        [
            IncludeLaunchDescription(
                PythonLaunchDescriptionSource(gripper), launch_arguments={"interface": "position"}
            )
        ]
    )
