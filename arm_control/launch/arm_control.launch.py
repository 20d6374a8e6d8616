"""The controllers of a world that is already up: one spawner after the other, each when ready."""

from launch_py import DeclareLaunchArgument, LaunchDescription, ProcessExited
from launch_py.ros import FindPackageShare, Node
from launch_py.substitutions import LaunchConfiguration, PathJoinSubstitution


def generate_launch_description() -> LaunchDescription:
    """Return the spawners of the broadcaster and of the position controller."""
    controllers = PathJoinSubstitution(
        [FindPackageShare("arm_control"), "config", "arm_control.yaml"]
    )

    def spawner(name: str, **options: object) -> Node:
        return Node(
            package="arm_control",
            executable="spawner",
            exec_name=f"spawner_{name}",
            arguments=[
                name,
                "--controller-manager",
                LaunchConfiguration("controller_manager"),
                "--param-file",
                LaunchConfiguration("controllers"),
            ],
            ready=ProcessExited(),
            **options,
        )

    broadcaster = spawner("joint_state_broadcaster")
    position = spawner("position_controller", depends_on=broadcaster)
    return LaunchDescription(
        [
            DeclareLaunchArgument(
                "controllers",
                default_value=controllers,
                description="parameter file of the controllers",
            ),
            DeclareLaunchArgument(
                "controller_manager",
                default_value="/controller_manager",
                description="the controller manager's node",
            ),
            broadcaster,
            position,
        ]
    )
