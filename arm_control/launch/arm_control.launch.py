"""The controllers of a world that is already up: one spawner after the other, each when ready."""

from typing import Any

from launch_py import DeclareLaunchArgument, LaunchDescription, ProcessExited
from launch_py.conditions import IfCondition, UnlessCondition
from launch_py.ros import FindPackageShare, Node
from launch_py.substitutions import (
    EqualsSubstitution,
    IfElseSubstitution,
    LaunchConfiguration,
    PathJoinSubstitution,
)

IS_ROS1 = EqualsSubstitution(LaunchConfiguration("interface"), "ros1")


def spawner(*names: str, **options: Any) -> Node:
    """Return what starts controllers in the manager that the arguments name."""
    return Node(
        package="arm_control",
        executable="spawner",
        exec_name=f"spawner_{names[0]}",
        arguments=[
            *names,
            "--controller-manager",
            LaunchConfiguration("controller_manager"),
            "--param-file",
            LaunchConfiguration("controllers"),
        ],
        ready=ProcessExited(),
        **options,
    )


def arguments() -> list[DeclareLaunchArgument]:
    """Return the declarations."""
    file = IfElseSubstitution(
        IS_ROS1, if_value="arm_control_ros1.yaml", else_value="arm_control.yaml"
    )
    return [
        DeclareLaunchArgument(
            "interface",
            default_value="ros2",
            choices=["ros2", "ros1"],
            description="one controller of all joints, or as in ROS 1 one for each under /arm",
        ),
        DeclareLaunchArgument(
            "controllers",
            default_value=PathJoinSubstitution([FindPackageShare("arm_control"), "config", file]),
            description="parameter file of the controllers",
        ),
        DeclareLaunchArgument(
            "controller_manager",
            default_value=IfElseSubstitution(
                IS_ROS1, if_value="/arm/controller_manager", else_value="/controller_manager"
            ),
            description="the controller manager's node",
        ),
    ]


def generate_launch_description() -> LaunchDescription:
    """Return the spawners of the broadcaster and of what commands positions."""
    broadcaster = spawner("joint_state_broadcaster")
    position = spawner(
        "position_controller", depends_on=broadcaster, condition=UnlessCondition(IS_ROS1)
    )
    single = spawner(
        *(f"j{i}p_controller" for i in range(4)),
        depends_on=broadcaster,
        condition=IfCondition(IS_ROS1),
    )
    return LaunchDescription([*arguments(), broadcaster, position, single])
