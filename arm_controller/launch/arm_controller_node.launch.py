"""Starts the controller node with a pose from a file: config/params.yaml or another."""

from arm_control.course import COURSE_ARGUMENT, INTERFACE_ARGUMENT, take_course
from launch_py import DeclareLaunchArgument, LaunchDescription, Notified
from launch_py.actions import OpaqueFunction
from launch_py.ros import FindPackageShare, Node
from launch_py.substitutions import (
    EqualsSubstitution,
    IfElseSubstitution,
    LaunchConfiguration,
    PathJoinSubstitution,
)


def generate_launch_description() -> LaunchDescription:
    """Return the node."""
    is_ros1 = EqualsSubstitution(LaunchConfiguration("interface"), "ros1")
    file = IfElseSubstitution(is_ros1, if_value="params_ros1.yaml", else_value="params.yaml")
    parameters = PathJoinSubstitution([FindPackageShare("arm_controller"), "config", file])
    return LaunchDescription(
        [
            DeclareLaunchArgument("course", **COURSE_ARGUMENT),
            OpaqueFunction(function=take_course),
            DeclareLaunchArgument("interface", **INTERFACE_ARGUMENT),
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
                ready=Notified(),
            ),
        ]
    )
