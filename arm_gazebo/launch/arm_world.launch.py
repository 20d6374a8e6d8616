"""The world with the arm in it: the simulation and the state publisher, no controllers.

Without controllers the arm falls, as in Gazebo; `hold_joints:=true` keeps it where it starts. With
`spawn` joints that no controller claims hold their position.
"""

import shlex
from collections.abc import Mapping
from typing import Any

from arm_control.course import (
    COURSE_ARGUMENT,
    HARDWARE_INTERFACE_ARGUMENT,
    INTERFACE_ARGUMENT,
    take_course,
)
from launch_py import Action, DeclareLaunchArgument, IncludeLaunchDescription, LaunchDescription
from launch_py.actions import OpaqueFunction
from launch_py.launch_description_sources import PythonLaunchDescriptionSource
from launch_py.ros import FindPackageShare
from launch_py.substitutions import (
    Call,
    EqualsSubstitution,
    IfElseSubstitution,
    LaunchConfiguration,
    NotSubstitution,
    PathJoinSubstitution,
)

IS_ROS1 = EqualsSubstitution(LaunchConfiguration("interface"), "ros1")
DESCRIPTION_ARGUMENTS: dict[str, tuple[Any, ...]] = {
    "j0_pos": ("0.0", "where j0 starts, in rad"),
    "j1_pos": ("0.0", "where j1 starts, in rad"),
    "j2_pos": ("0.0", "where j2 starts, in rad"),
    "j3_pos": ("0.0", "where j3 starts, in rad"),
    "base": ("fixed", "bolted to the floor, or standing free on its foot", ["fixed", "free"]),
    "camera": (
        "front",
        "on the foot looking forward, or 0.75 m away looking at the arm",
        ["front", "side", "none"],
    ),
    "camera_profile": (
        "standard",
        "320x240, or 800x800 with noise and also on camera/image_raw; ros1 is large, on "
        "/camera/image_raw and /camera/camera_info in every namespace",
        ["standard", "large", "ros1"],
    ),
    "camera_width": ("", "width of the pictures in pixels, instead of the profile's"),
    "camera_height": ("", "height of the pictures in pixels, instead of the profile's"),
    "camera_hfov": ("", "horizontal field of view in rad, instead of the profile's"),
    "camera_xyz": ("", "another place of the camera in base_link, in m: 'x y z'"),
    "camera_rpy": ("", "another orientation of the camera, in rad: 'roll pitch yaw'"),
    "camera_box": ("", "size of a box drawn in place of the camera's case, in m: 'x y z'"),
    "camera_box_xyz": ("0 0 0", "middle of that box in camera_link, in m"),
    "camera_box_rgba": ("0.63 0.13 0.94 1", "colour of that box, from 0 to 1"),
    "servo_rgba": ("0.15 0.16 0.18 1", "colour of the servos' cases, from 0 to 1"),
    "velocity_limit": ("2.0", "velocity limit of every joint, in rad/s; the original has 0.1"),
    "effort_limit": ("5.0", "effort limit of every joint, in N m; the original has 300"),
    "j1_limit": ("3.14", "limit of j1 in both directions, in rad"),
    "command_interfaces": (
        "position velocity effort",
        "what a controller can command at every joint; the original has position only",
        ["position", "position velocity", "position velocity effort"],
    ),
    "prefix": (
        "",
        "prefix of link and joint names; a file of `controllers` must use it as well, for example "
        "${prefix}j0",
    ),
}

ROS1_ARGUMENTS = {
    "gui": ("false", "open a window, as with headless:=false", ["true", "false"]),
    "debug": (
        "false",
        "ignored; use `arm run --prefix 'gdb -ex run --args'` to debug",
        ["true", "false"],
    ),
}
"""Arguments of the ROS 1 original's launch file that have other names here."""

ROS1_DEFAULTS = {"camera": "side", "camera_profile": "ros1"}
"""Arguments of the description that have another default with interface:=ros1."""


def declared(arguments: Mapping[str, tuple[Any, ...]]) -> list[DeclareLaunchArgument]:
    """Return the declarations of a table of arguments."""
    return [
        DeclareLaunchArgument(
            name,
            default_value=IfElseSubstitution(
                IS_ROS1, if_value=ROS1_DEFAULTS[name], else_value=default
            )
            if name in ROS1_DEFAULTS
            else default,
            description=description,
            choices=choices[0] if choices else None,
        )
        for name, (default, description, *choices) in arguments.items()
    ]


def assignments(**arguments: str) -> str:
    """Return what differs from the arm's own defaults as words NAME:=VALUE.

    Another model by `model:=` may have arguments of these names and other defaults.
    """
    return shlex.join(
        f"{name}:={value}"
        for name, value in arguments.items()
        if value != DESCRIPTION_ARGUMENTS[name][0]
    )


def arguments() -> list[Action]:
    """Return the launch arguments, and what sets them from the course."""
    model = PathJoinSubstitution([FindPackageShare("arm_description"), "urdf", "arm.urdf.xacro"])
    file = IfElseSubstitution(
        IS_ROS1, if_value="arm_control_ros1.yaml", else_value="arm_control.yaml"
    )
    controllers = PathJoinSubstitution([FindPackageShare("arm_control"), "config", file])
    return [
        DeclareLaunchArgument("course", **COURSE_ARGUMENT),
        OpaqueFunction(function=take_course),
        DeclareLaunchArgument("model", default_value=model, description="URDF or xacro file"),
        DeclareLaunchArgument("interface", **INTERFACE_ARGUMENT),
        *declared(
            {
                "robot_name": (
                    "arm",
                    "with interface:=ros1, the namespace of all nodes of the robot",
                ),
                "namespace": (
                    IfElseSubstitution(IS_ROS1, if_value=LaunchConfiguration("robot_name")),
                    "namespace of all nodes of the robot",
                ),
                "controllers": (
                    controllers,
                    "parameter file of the controller manager and its controllers",
                ),
                "spawn": (
                    "",
                    "controllers to start with the simulation, separated by commas",
                ),
                "hold_joints": (
                    NotSubstitution(EqualsSubstitution(LaunchConfiguration("spawn"), "")),
                    "joints that no controller claims hold their position; by default if `spawn` "
                    "names controllers",
                ),
            }
        ),
        *declared(DESCRIPTION_ARGUMENTS),
        *declared(ROS1_ARGUMENTS),
        DeclareLaunchArgument("hardware_interface", **HARDWARE_INTERFACE_ARGUMENT),
        DeclareLaunchArgument(
            "headless",
            default_value=NotSubstitution(LaunchConfiguration("gui")),
            description="false opens a window on the simulation",
            choices=["true", "false"],
        ),
    ]


def generate_launch_description() -> LaunchDescription:
    """Return the simulation of the arm."""
    simulation = PathJoinSubstitution([FindPackageShare("arm_gazebo"), "launch", "sim.launch.py"])
    return LaunchDescription(
        [
            *arguments(),
            IncludeLaunchDescription(
                PythonLaunchDescriptionSource(simulation),
                launch_arguments={
                    "model_args": Call(
                        assignments,
                        **{name: LaunchConfiguration(name) for name in DESCRIPTION_ARGUMENTS},
                    )
                },
            ),
        ]
    )
