"""The myCobot without physics: its frames and joint states, and RViz where there is one."""

import os
import shutil

from launch_py import (
    DeclareLaunchArgument,
    ExecuteProcess,
    LaunchDescription,
    Notified,
    SetLaunchConfiguration,
)
from launch_py.conditions import IfCondition
from launch_py.packages import Packages
from launch_py.ros import FindPackageShare, Node, ParameterValue
from launch_py.substitutions import (
    AndSubstitution,
    Call,
    LaunchConfiguration,
    NotSubstitution,
    PathJoinSubstitution,
)

SLIDERS = "joint_state_publisher_gui"
SWITCH = ["true", "false"]

XACRO_ARGUMENTS = {
    "prefix": ("", "put before the name of every link and joint", None),
    "add_world": ("true", "the link 'world' holds the base", SWITCH),
    "base_link": ("base_link", "what the base is called", None),
    "base_type": ("g_shape", "what the arm stands on", ["g_shape"]),
    "flange_link": ("link6_flange", "what tools are screwed to", None),
    "gripper_type": ("adaptive_gripper", "which gripper", ["adaptive_gripper"]),
    "use_gazebo": ("false", "the simulation is the hardware, not a mock", SWITCH),
    "use_gripper": ("true", "with the gripper", SWITCH),
    "use_camera": ("false", "with a depth camera on a stand", SWITCH),
}


def describe(model: str, *values: str) -> str:
    """Return the URDF text of the model, given the values of XACRO_ARGUMENTS."""
    from arm_description.xacro_expansion import expand_xacro

    return expand_xacro(model, dict(zip(XACRO_ARGUMENTS, values, strict=True)))


def arguments() -> list[DeclareLaunchArgument]:
    """Return the declarations."""
    share = FindPackageShare("mycobot_description")
    robot = LaunchConfiguration("robot_name")
    gui = "true" if SLIDERS in Packages(os.environ).names() else "false"
    rviz = "true" if shutil.which("rviz2") else "false"
    table = {
        "robot_name": ("mycobot_280", "which robot of this package", None),
        **XACRO_ARGUMENTS,
        "urdf_model": (
            PathJoinSubstitution([share, "urdf", "robots", [robot, ".urdf.xacro"]]),
            "URDF or xacro file",
            None,
        ),
        "rviz_config_file": (
            PathJoinSubstitution([share, "config", "rviz", [robot, "_description.rviz"]]),
            "what RViz shows",
            None,
        ),
        "jsp_gui": (gui, f"sliders; {SLIDERS} comes with a ROS 2 installation", SWITCH),
        "use_jsp": ("true", "publish joint states where no sliders do", SWITCH),
        "use_rviz": (rviz, "start RViz; it comes with a ROS 2 installation", SWITCH),
        "use_sim_time": ("false", "the nodes' clock is a simulation's", SWITCH),
    }
    return [
        DeclareLaunchArgument(name, default_value=default, description=text, choices=choices)
        for name, (default, text, choices) in table.items()
    ]


def generate_launch_description() -> LaunchDescription:
    """Return the state publisher, what publishes joint states, and RViz."""
    use_sim_time = LaunchConfiguration("use_sim_time")
    description = {
        "robot_description": ParameterValue(
            LaunchConfiguration("robot_description"), value_type=str
        ),
        "use_sim_time": use_sim_time,
    }
    gui = LaunchConfiguration("jsp_gui")
    return LaunchDescription(
        [
            *arguments(),
            SetLaunchConfiguration(
                "robot_description",
                Call(
                    describe,
                    LaunchConfiguration("urdf_model"),
                    *(LaunchConfiguration(name) for name in XACRO_ARGUMENTS),
                ),
            ),
            Node(
                package="arm_description",
                executable="robot_state_publisher",
                parameters=[description],
                ready=Notified(),
            ),
            Node(
                package="arm_description",
                executable="joint_state_publisher",
                parameters=[description],
                ready=Notified(),
                condition=IfCondition(
                    AndSubstitution(LaunchConfiguration("use_jsp"), NotSubstitution(gui))
                ),
            ),
            Node(package=SLIDERS, executable=SLIDERS, condition=IfCondition(gui)),
            ExecuteProcess(
                cmd=[
                    *("rviz2", "-d", LaunchConfiguration("rviz_config_file")),
                    # The file's own fixed frame is base_link: not there with a prefix.
                    *("-f", [LaunchConfiguration("prefix"), LaunchConfiguration("base_link")]),
                    *("--ros-args", "-p", ["use_sim_time:=", use_sim_time]),
                ],
                name="rviz2",
                condition=IfCondition(LaunchConfiguration("use_rviz")),
            ),
        ]
    )
