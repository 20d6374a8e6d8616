"""Spawns the controllers of a running simulation, one after the other.

As in ROS 1, `controllers` can also be the names of the controllers. One spawner starts all of them.
"""

import re
from typing import Any

from arm_control.course import (
    COURSE_ARGUMENT,
    HARDWARE_INTERFACE_ARGUMENT,
    INTERFACE_ARGUMENT,
    launch_arguments,
    take_course,
)
from launch_py import Action, DeclareLaunchArgument, Finished, LaunchDescription
from launch_py.actions import OpaqueFunction
from launch_py.launch_context import LaunchContext
from launch_py.ros import FindPackageShare, Node
from launch_py.substitutions import (
    EqualsSubstitution,
    IfElseSubstitution,
    LaunchConfiguration,
    PathJoinSubstitution,
)

IS_ROS1 = EqualsSubstitution(LaunchConfiguration("interface"), "ros1")
DEFAULT_FILE = PathJoinSubstitution(
    [
        FindPackageShare("arm_control"),
        "config",
        IfElseSubstitution(
            IS_ROS1, if_value="arm_control_ros1.yaml", else_value="arm_control.yaml"
        ),
    ]
)
NAMES = re.compile(r"\s*\w+(\s+\w+)*\s*")
"""The names of controllers. The path of a parameter file has a dot or a slash."""


def spawner(*names: str, file: str, **options: Any) -> Node:
    """Return a spawner of controllers for the manager that the launch arguments name."""
    return Node(
        package="arm_control",
        executable="spawner",
        exec_name=f"spawner_{names[0]}",
        arguments=[
            *names,
            "--controller-manager",
            LaunchConfiguration("controller_manager"),
            "--param-file",
            file,
        ],
        ready=Finished(),
        **options,
    )


def spawners(context: LaunchContext) -> list[Action]:
    """Return the spawner of the named controllers, or of the broadcaster and then the others."""
    words = context.launch_configurations
    file = words["controllers"]
    if NAMES.fullmatch(file):
        names = file.split()
        file = launch_arguments(words["course"]).get("controllers") or DEFAULT_FILE.perform(context)
        return [spawner(*names, file=file)]
    broadcaster = spawner("joint_state_broadcaster", file=file)
    if words["interface"] == "ros1":
        names = [f"j{i}p_controller" for i in range(4)]
    else:
        names = ["position_controller"]
    return [broadcaster, spawner(*names, file=file, depends_on=broadcaster)]


def arguments() -> list[Action]:
    """Return the launch arguments, and what sets them from the course."""
    return [
        DeclareLaunchArgument("course", **COURSE_ARGUMENT),
        OpaqueFunction(function=take_course),
        DeclareLaunchArgument("interface", **INTERFACE_ARGUMENT),
        DeclareLaunchArgument(
            "robot_name",
            default_value="arm",
            description="with interface:=ros1, the namespace of the controller manager",
        ),
        DeclareLaunchArgument("hardware_interface", **HARDWARE_INTERFACE_ARGUMENT),
        DeclareLaunchArgument(
            "controllers",
            default_value=DEFAULT_FILE,
            description="parameter file of the controllers; or, as in ROS 1, the names of those to "
            "spawn: 'NAME NAME'",
        ),
        DeclareLaunchArgument(
            "controller_manager",
            default_value=IfElseSubstitution(
                IS_ROS1,
                if_value=PathJoinSubstitution(
                    ["/", LaunchConfiguration("robot_name"), "controller_manager"]
                ),
                else_value="/controller_manager",
            ),
            description="the controller manager's node",
        ),
    ]


def generate_launch_description() -> LaunchDescription:
    """Return the spawners of the broadcaster and the position controllers."""
    return LaunchDescription([*arguments(), OpaqueFunction(function=spawners)])
