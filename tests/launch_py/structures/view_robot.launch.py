# A display file: sliders in a window or without one.
# starts: joint_state_publisher_gui robot_state_publisher rviz2
from launch.actions import DeclareLaunchArgument
from launch.conditions import IfCondition, UnlessCondition
from launch.substitutions import Command, LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare

from launch import LaunchDescription


def generate_launch_description():
    share = FindPackageShare("demo_arm")
    return LaunchDescription(
        [
            DeclareLaunchArgument(name="gui", default_value="true", choices=["true", "false"]),
            DeclareLaunchArgument(name="model", default_value=share / "urdf" / "arm.urdf.xacro"),
            Node(
                package="joint_state_publisher",
                executable="joint_state_publisher",
                condition=UnlessCondition(LaunchConfiguration("gui")),
            ),
            Node(
                package="joint_state_publisher_gui",
                executable="joint_state_publisher_gui",
                condition=IfCondition(LaunchConfiguration("gui")),
            ),
            Node(
                package="robot_state_publisher",
                executable="robot_state_publisher",
                parameters=[
                    {
                        "robot_description": ParameterValue(
                            Command(["xacro ", LaunchConfiguration("model")]), value_type=str
                        )
                    }
                ],
            ),
            Node(package="rviz2", executable="rviz2", name="rviz2", output="screen"),
        ]
    )
