"""The world with the arm in it: the simulation and the state publisher, no controllers.

The joints hold their position; `hold_joints:=false` lets the arm fall, as it does in Gazebo
before any controller is there.
"""

import shlex

from launch_py import DeclareLaunchArgument, IncludeLaunchDescription, LaunchDescription
from launch_py.launch_description_sources import PythonLaunchDescriptionSource
from launch_py.ros import FindPackageShare
from launch_py.substitutions import (
    Call,
    EqualsSubstitution,
    IfElseSubstitution,
    LaunchConfiguration,
    PathJoinSubstitution,
)

DESCRIPTION_ARGUMENTS = {
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
        "320x240, or 800x800 with noise and also on /camera/image_raw",
        ["standard", "large"],
    ),
    "velocity_limit": ("2.0", "of every joint, in rad/s; 0.1 gives the original arm's"),
    "effort_limit": ("5.0", "of every joint, in N m; 300 gives the original arm's"),
    "j1_limit": ("3.14", "of j1 to both sides, in rad"),
    "prefix": (
        "",
        "put before the names of links and joints; a file of `controllers` has to name them so, "
        "as ${prefix}j0 for one",
    ),
}


def assignments(**arguments: str) -> str:
    """Return what differs from the arm's own defaults as words NAME:=VALUE.

    Another model by `model:=` may have arguments of these names and other defaults.
    """
    return shlex.join(
        f"{name}:={value}"
        for name, value in arguments.items()
        if value != DESCRIPTION_ARGUMENTS[name][0]
    )


def generate_launch_description() -> LaunchDescription:
    """Return the simulation of the arm."""
    model = PathJoinSubstitution([FindPackageShare("arm_description"), "urdf", "arm.urdf.xacro"])
    is_ros1 = EqualsSubstitution(LaunchConfiguration("interface"), "ros1")
    file = IfElseSubstitution(
        is_ros1, if_value="arm_control_ros1.yaml", else_value="arm_control.yaml"
    )
    controllers = PathJoinSubstitution([FindPackageShare("arm_control"), "config", file])
    simulation = PathJoinSubstitution([FindPackageShare("arm_gazebo"), "launch", "sim.launch.py"])
    return LaunchDescription(
        [
            DeclareLaunchArgument("model", default_value=model, description="URDF or xacro file"),
            DeclareLaunchArgument(
                "interface",
                default_value="ros2",
                choices=["ros2", "ros1"],
                description="one controller of all joints, or as in ROS 1 one for each under /arm",
            ),
            DeclareLaunchArgument(
                "namespace",
                default_value=IfElseSubstitution(is_ros1, if_value="arm"),
                description="of all nodes of the robot",
            ),
            DeclareLaunchArgument(
                "controllers",
                default_value=controllers,
                description="parameter file of the controller manager and its controllers",
            ),
            DeclareLaunchArgument(
                "spawn",
                default_value="",
                description="controllers to start with the simulation, with commas",
            ),
            *(
                DeclareLaunchArgument(
                    name,
                    default_value=default,
                    description=description,
                    choices=choices[0] if choices else None,
                )
                for name, (default, description, *choices) in DESCRIPTION_ARGUMENTS.items()
            ),
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
