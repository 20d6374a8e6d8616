"""A robot without physics, for launch files that know which one: frames, joint states, RViz."""

import os
import shutil

from launch_py import (
    Action,
    DeclareLaunchArgument,
    ExecuteProcess,
    IncludeLaunchDescription,
    LaunchDescription,
    Notified,
)
from launch_py.actions import OpaqueFunction
from launch_py.conditions import IfCondition
from launch_py.launch_context import LaunchContext
from launch_py.launch_description_sources import PythonLaunchDescriptionSource
from launch_py.packages import Packages
from launch_py.ros import FindPackageShare, Node, ParameterValue
from launch_py.substitutions import (
    AndSubstitution,
    Call,
    EqualsSubstitution,
    LaunchConfiguration,
    PathJoinSubstitution,
)

SLIDERS = "joint_state_publisher_gui"
SWITCH = ["true", "false"]


def whose(sliders: str) -> str:
    """Return what moves the joints: SLIDERS, the page, or nothing."""
    if sliders == "gui":
        return SLIDERS if SLIDERS in Packages(os.environ).names() else "page"
    return sliders


def page() -> IncludeLaunchDescription:
    """Return the page in the browser, whose sliders stand for the robot."""
    file = PathJoinSubstitution([FindPackageShare("arm_viewer"), "launch", "viewer.launch.py"])
    return IncludeLaunchDescription(
        PythonLaunchDescriptionSource(file),
        launch_arguments={"publish_joint_states": "true"},
        condition=IfCondition(moved_by("page")),
    )


def moved_by(source: str) -> EqualsSubstitution:
    """Return whether the joints are moved by this."""
    return EqualsSubstitution(Call(whose, LaunchConfiguration("sliders")), source)


def publisher(name: str, condition: IfCondition | None = None) -> Node:
    """Return a node of this package that reads the description."""
    text = ParameterValue(LaunchConfiguration("robot_description"), value_type=str)
    use_sim_time = LaunchConfiguration("use_sim_time")
    return Node(
        package="arm_description",
        executable=name,
        parameters=[{"robot_description": text, "use_sim_time": use_sim_time}],
        ready=Notified(),
        condition=condition,
    )


def rviz(context: LaunchContext) -> list[Action]:
    """Return RViz."""
    words = context.launch_configurations
    frame = ("-f", words["fixed_frame"]) if words["fixed_frame"] else ()
    clock = ("--ros-args", "-p", f"use_sim_time:={words['use_sim_time']}")
    return [
        ExecuteProcess(
            cmd=["rviz2", "-d", words["rviz_config_file"], *frame, *clock],
            name="rviz2",
            condition=IfCondition(LaunchConfiguration("use_rviz")),
        )
    ]


def generate_launch_description() -> LaunchDescription:
    """Return the state publisher, what publishes joint states, and RViz."""
    table = {
        "robot_description": (None, "text of the URDF", None),
        "sliders": (
            "page",
            f"that move the joints: the page's in the browser; gui: of {SLIDERS}, which comes "
            "with a ROS 2 installation, or else the page's",
            ["page", "gui", "none"],
        ),
        "use_jsp": ("true", "publish joint states where no sliders do", SWITCH),
        "use_rviz": (
            "true" if shutil.which("rviz2") else "false",
            "start RViz; it comes with a ROS 2 installation",
            SWITCH,
        ),
        "rviz_config_file": (
            PathJoinSubstitution([FindPackageShare("arm_description"), "config/rviz/arm.rviz"]),
            "what RViz shows",
            None,
        ),
        "fixed_frame": ("", "from where RViz looks, unless its file's is right", None),
        "use_sim_time": ("false", "the nodes' clock is a simulation's", SWITCH),
    }
    return LaunchDescription(
        [
            *(
                DeclareLaunchArgument(name, default_value=value, description=text, choices=choices)
                for name, (value, text, choices) in table.items()
            ),
            publisher("robot_state_publisher"),
            publisher(
                "joint_state_publisher",
                IfCondition(AndSubstitution(LaunchConfiguration("use_jsp"), moved_by("none"))),
            ),
            Node(package=SLIDERS, executable=SLIDERS, condition=IfCondition(moved_by(SLIDERS))),
            page(),
            OpaqueFunction(function=rviz),
        ]
    )
