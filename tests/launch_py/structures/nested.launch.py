# Includes of all formats, each with its arguments.
# starts: gripper driver robot_state_publisher gripper-2
from launch.actions import IncludeLaunchDescription
from launch.launch_description_sources import AnyLaunchDescriptionSource
from launch.substitutions import PathJoinSubstitution, ThisLaunchFileDir
from launch_ros.substitutions import FindPackageShare
from launch_xml.launch_description_sources import XMLLaunchDescriptionSource

from launch import LaunchDescription


def generate_launch_description():
    gripper = PathJoinSubstitution([FindPackageShare("demo_arm"), "launch", "gripper.launch.py"])
    return LaunchDescription(
        [
            IncludeLaunchDescription(
                AnyLaunchDescriptionSource(gripper), launch_arguments={"joint": "f"}.items()
            ),
            IncludeLaunchDescription(
                XMLLaunchDescriptionSource([ThisLaunchFileDir(), "/bringup.launch.xml"]),
                launch_arguments=[("sim", "false")],
            ),
        ]
    )
