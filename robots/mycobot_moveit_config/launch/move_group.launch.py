"""move_group for a myCobot that runs, simulated or real, with this package's configuration."""

import shutil

from launch_py import DeclareLaunchArgument, IncludeLaunchDescription, LaunchDescription
from launch_py.launch_description_sources import PythonLaunchDescriptionSource
from launch_py.ros import FindPackageShare
from launch_py.substitutions import LaunchConfiguration, PathJoinSubstitution


def generate_launch_description() -> LaunchDescription:
    """Return move_group, and RViz where it is wanted."""
    rviz = "true" if shutil.which("rviz2") else "false"
    configuration = PathJoinSubstitution(
        [FindPackageShare("mycobot_moveit_config"), "config", LaunchConfiguration("robot_name")]
    )
    return LaunchDescription(
        [
            DeclareLaunchArgument(
                "robot_name",
                default_value="mycobot_280",
                description="robot whose configuration is taken",
            ),
            DeclareLaunchArgument(
                "use_rviz",
                default_value=rviz,
                choices=["true", "false"],
                description="start RViz; where it is not installed, the page in its place",
            ),
            DeclareLaunchArgument(
                "rviz_config_file",
                default_value=PathJoinSubstitution(
                    [FindPackageShare("arm_description"), "config", "rviz", "arm.rviz"]
                ),
                description="what RViz shows",
            ),
            IncludeLaunchDescription(
                PythonLaunchDescriptionSource(
                    PathJoinSubstitution(
                        [FindPackageShare("arm_planning"), "launch", "move_group.launch.py"]
                    )
                ),
                launch_arguments={"moveit_config": configuration},
            ),
            IncludeLaunchDescription(
                PythonLaunchDescriptionSource(
                    PathJoinSubstitution(
                        [FindPackageShare("arm_viewer"), "launch", "rviz.launch.py"]
                    )
                ),
                launch_arguments={"page_is_open": "false"},
            ),
        ]
    )
