"""The myCobot to plan with, without physics: mock hardware, move_group and the page."""

from launch_py import DeclareLaunchArgument, IncludeLaunchDescription, LaunchDescription
from launch_py.launch_description_sources import PythonLaunchDescriptionSource
from launch_py.ros import FindPackageShare
from launch_py.substitutions import LaunchConfiguration, PathJoinSubstitution


def generate_launch_description() -> LaunchDescription:
    """Return sim.launch.py with this robot on mock hardware."""
    robot = LaunchConfiguration("robot_name")
    configuration = PathJoinSubstitution(
        [FindPackageShare("mycobot_moveit_config"), "config", robot]
    )
    return LaunchDescription(
        [
            DeclareLaunchArgument(
                "robot_name", default_value="mycobot_280", description="robot to plan for"
            ),
            DeclareLaunchArgument(
                "viewer",
                default_value="true",
                choices=["true", "false"],
                description="serve the browser page that shows and moves it",
            ),
            IncludeLaunchDescription(
                PythonLaunchDescriptionSource(
                    PathJoinSubstitution(
                        [FindPackageShare("arm_gazebo"), "launch", "sim.launch.py"]
                    )
                ),
                launch_arguments={
                    "model": PathJoinSubstitution(
                        [
                            FindPackageShare("mycobot_description"),
                            "urdf/robots",
                            [robot, ".urdf.xacro"],
                        ]
                    ),
                    "controllers": PathJoinSubstitution(
                        [configuration, "ros2_controllers_template.yaml"]
                    ),
                    "spawn": "joint_state_broadcaster,arm_controller,gripper_action_controller",
                    "hardware": "mock",
                    "planning": "true",
                    "moveit_config": configuration,
                },
            ),
        ]
    )
