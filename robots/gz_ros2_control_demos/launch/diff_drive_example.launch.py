"""A two-wheeled robot driven by diff_drive_controller."""

from launch_py import IncludeLaunchDescription, LaunchDescription, ReadyPanel
from launch_py.conditions import LaunchConfigurationEquals
from launch_py.launch_description_sources import PythonLaunchDescriptionSource
from launch_py.ros import FindPackageShare
from launch_py.substitutions import PathJoinSubstitution


def generate_launch_description() -> LaunchDescription:
    """Return sim.launch.py with this robot; its other arguments are available here as well."""
    share = FindPackageShare("gz_ros2_control_demos")
    simulation = PathJoinSubstitution([FindPackageShare("arm_gazebo"), "launch", "sim.launch.py"])
    return LaunchDescription(
        [
            IncludeLaunchDescription(
                PythonLaunchDescriptionSource(simulation),
                launch_arguments={
                    "model": PathJoinSubstitution([share, "urdf/diff_drive.urdf.xacro"]),
                    "controllers": PathJoinSubstitution(
                        [share, "config/diff_drive_controller.yaml"]
                    ),
                    "base": "free",
                },
            ),
            ReadyPanel(
                title="The robot on two wheels is up",
                topics=[
                    ("/diff_drive_base_controller/cmd_vel", "geometry_msgs/msg/TwistStamped"),
                    ("/diff_drive_base_controller/odom", "nav_msgs/msg/Odometry"),
                    ("/tf", "odom to base_link"),
                ],
                commands=[("in circles", "arm run gz_ros2_control_demos example_diff_drive")],
                condition=LaunchConfigurationEquals("copies", "1"),
            ),
        ]
    )
