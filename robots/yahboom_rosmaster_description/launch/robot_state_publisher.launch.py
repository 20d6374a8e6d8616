"""The ROSMASTER X3 without physics: its frames, sliders for its wheels, and RViz."""

import os
import shutil

from launch_py import (
    DeclareLaunchArgument,
    ExecuteProcess,
    IncludeLaunchDescription,
    LaunchDescription,
    Notified,
    SetLaunchConfiguration,
)
from launch_py.conditions import IfCondition, UnlessCondition
from launch_py.launch_description_sources import PythonLaunchDescriptionSource
from launch_py.packages import Packages
from launch_py.ros import FindPackageShare, Node, ParameterValue
from launch_py.substitutions import Call, LaunchConfiguration, PathJoinSubstitution

SLIDERS = "joint_state_publisher_gui"
SWITCH = ["true", "false"]

XACRO_ARGUMENTS = {
    "prefix": ("", "put before the name of every link and joint", None),
    "use_gazebo": ("false", "the simulation is the hardware, not a mock", SWITCH),
}


def describe(model: str, *values: str) -> str:
    """Return the URDF text of the model, given the values of XACRO_ARGUMENTS."""
    from arm_description.xacro_expansion import expand_xacro

    return expand_xacro(model, dict(zip(XACRO_ARGUMENTS, values, strict=True)))


def arguments() -> list[DeclareLaunchArgument]:
    """Return the declarations."""
    share = FindPackageShare("yahboom_rosmaster_description")
    rviz = "true" if shutil.which("rviz2") else "false"
    table = {
        "robot_name": ("rosmaster_x3", "which robot of this package", None),
        **XACRO_ARGUMENTS,
        "urdf_model": (
            PathJoinSubstitution(
                [share, "urdf", "robots", [LaunchConfiguration("robot_name"), ".urdf.xacro"]]
            ),
            "URDF or xacro file",
            None,
        ),
        "rviz_config_file": (
            PathJoinSubstitution([share, "config/rviz/yahboom_rosmaster_description.rviz"]),
            "what RViz shows",
            None,
        ),
        "jsp_gui": (
            "true",
            f"sliders for the wheels: {SLIDERS} of a ROS 2 installation, or else the page",
            SWITCH,
        ),
        "use_rviz": (rviz, "start RViz; it comes with a ROS 2 installation", SWITCH),
        "use_sim_time": ("false", "the nodes' clock is a simulation's", SWITCH),
    }
    return [
        DeclareLaunchArgument(name, default_value=default, description=text, choices=choices)
        for name, (default, text, choices) in table.items()
    ]


def sliders(wanted: IfCondition) -> Node | IncludeLaunchDescription:
    """Return what publishes joint states by sliders."""
    if SLIDERS in Packages(os.environ).names():
        return Node(package=SLIDERS, executable=SLIDERS, condition=wanted)
    page = PathJoinSubstitution([FindPackageShare("arm_viewer"), "launch", "viewer.launch.py"])
    return IncludeLaunchDescription(
        PythonLaunchDescriptionSource(page),
        launch_arguments={"publish_joint_states": "true"},
        condition=wanted,
    )


def generate_launch_description() -> LaunchDescription:
    """Return the state publisher, what publishes joint states, and RViz."""
    use_sim_time = LaunchConfiguration("use_sim_time")
    text = ParameterValue(LaunchConfiguration("robot_description"), value_type=str)
    description = {"robot_description": text, "use_sim_time": use_sim_time}
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
                condition=UnlessCondition(gui),
            ),
            sliders(IfCondition(gui)),
            ExecuteProcess(
                cmd=[
                    *("rviz2", "-d", LaunchConfiguration("rviz_config_file")),
                    # The file's own fixed frame is base_link: not there with a prefix.
                    *("-f", [LaunchConfiguration("prefix"), "base_link"]),
                    *("--ros-args", "-p", ["use_sim_time:=", use_sim_time]),
                ],
                name="rviz2",
                condition=IfCondition(LaunchConfiguration("use_rviz")),
            ),
        ]
    )
