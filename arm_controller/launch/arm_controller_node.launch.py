"""The controller node with a pose from a file: config/params.yaml or another."""

from launch_py import DeclareLaunchArgument, LaunchDescription, Notified
from launch_py.ros import FindPackageShare, Node
from launch_py.substitutions import LaunchConfiguration, PathJoinSubstitution


def generate_launch_description() -> LaunchDescription:
    """Return the node."""
    parameters = PathJoinSubstitution([FindPackageShare("arm_controller"), "config", "params.yaml"])
    return LaunchDescription(
        [
            DeclareLaunchArgument(
                "params_file",
                default_value=parameters,
                description="parameter file with desired_param",
            ),
            Node(
                package="arm_controller",
                executable="arm_controller_node",
                parameters=[LaunchConfiguration("params_file")],
                ready=Notified(),
            ),
        ]
    )
