"""Starts the controller node with a pose from a file: config/params.yaml or another."""

from launch_py import DeclareLaunchArgument, LaunchDescription, LogLine
from launch_py.ros import FindPackageShare, Node
from launch_py.substitutions import (
    EqualsSubstitution,
    IfElseSubstitution,
    LaunchConfiguration,
    PathJoinSubstitution,
)


def generate_launch_description() -> LaunchDescription:
    """Return the node."""
    course = LaunchConfiguration("course")
    is_ros1 = EqualsSubstitution(LaunchConfiguration("interface"), "ros1")
    own_file = IfElseSubstitution(is_ros1, if_value="params_ros1.yaml", else_value="params.yaml")
    parameters = IfElseSubstitution(
        EqualsSubstitution(course, "none"),
        if_value=PathJoinSubstitution([FindPackageShare("arm_controller"), "config", own_file]),
        else_value=PathJoinSubstitution(
            [FindPackageShare("arm_control"), "config", "courses", [course, ".yaml"]]
        ),
    )
    return LaunchDescription(
        [
            DeclareLaunchArgument(
                "course",
                default_value="none",
                description="whose tutorial to follow: a file in arm_control/config/courses",
                choices=["none", "S0", "S1", "S2", "S3"],
            ),
            DeclareLaunchArgument(
                "interface",
                # Course S3 is of ROS 1.
                default_value=IfElseSubstitution(
                    EqualsSubstitution(course, "S3"), if_value="ros1", else_value="ros2"
                ),
                description="one controller for all joints, or as in ROS 1 one for each under /arm",
                choices=["ros2", "ros1"],
            ),
            DeclareLaunchArgument(
                "params_file",
                default_value=parameters,
                description="parameter file with desired_param",
            ),
            DeclareLaunchArgument(
                "namespace",
                default_value=IfElseSubstitution(is_ros1, if_value="arm"),
                description="namespace of the node",
            ),
            Node(
                package="arm_controller",
                executable="arm_controller_node",
                namespace=LaunchConfiguration("namespace"),
                parameters=[LaunchConfiguration("params_file")],
                ready=LogLine("Set the parameter desired_param"),
            ),
        ]
    )
