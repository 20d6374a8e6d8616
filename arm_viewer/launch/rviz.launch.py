"""RViz, or the browser page if RViz is not installed."""

from launch_py import Action, DeclareLaunchArgument, ExecuteProcess, LaunchDescription
from launch_py.actions import IncludeLaunchDescription, OpaqueFunction
from launch_py.errors import NotFoundError
from launch_py.launch_context import LaunchContext
from launch_py.launch_description_sources import PythonLaunchDescriptionSource
from launch_py.substitutions import PathJoinSubstitution, ThisLaunchFileDir
from launch_py.system.programs import find_program

OF_THE_ARM = "config/rviz/arm.rviz"
SWITCH = ["true", "false"]
ARGUMENTS = {
    "use_rviz": ("false", "start RViz, or the browser page if it is not installed", SWITCH),
    "rviz_config_file": ("", "RViz configuration", None),
    "fixed_frame": ("", "RViz's fixed frame; by default that of its configuration", None),
    "use_sim_time": ("true", "nodes use simulation time", SWITCH),
    "page_is_open": ("false", "another launch file opens the page", SWITCH),
}


def show(context: LaunchContext) -> list[Action]:
    """Return RViz, or the page if RViz is not installed; nothing if RViz is not requested."""
    words = context.launch_configurations
    if words["use_rviz"] != "true":
        return []
    try:
        find_program("rviz2", context.environment_variable("PATH") or "")
    except NotFoundError:
        return page(context)
    file = ("-d", words["rviz_config_file"]) if words["rviz_config_file"] else ()
    frame = ("-f", words["fixed_frame"]) if words["fixed_frame"] else ()
    clock = ("--ros-args", "-p", f"use_sim_time:={words['use_sim_time']}")
    return [ExecuteProcess(cmd=["rviz2", *file, *frame, *clock], name="rviz2")]


def page(context: LaunchContext) -> list[Action]:
    """Return the page unless another launch file opens it, and warn that it replaces RViz."""
    context.warnings.append(
        "RViz (rviz2), which comes with a ROS 2 installation, is not installed: the page in the "
        "browser shows the robot"
    )
    if context.launch_configurations["page_is_open"] == "true":
        return []
    file = PathJoinSubstitution([ThisLaunchFileDir(), "viewer.launch.py"])
    config = context.launch_configurations["rviz_config_file"]
    # All robots have the 4-DOF arm's file by default; without it the page fits its first view.
    shown = "" if config.endswith(OF_THE_ARM) else config
    return [
        IncludeLaunchDescription(
            PythonLaunchDescriptionSource(file), launch_arguments={"display_config": shown}
        )
    ]


def generate_launch_description() -> LaunchDescription:
    """Return the description that shows the robot."""
    return LaunchDescription(
        [
            *(
                DeclareLaunchArgument(name, default_value=value, description=text, choices=choices)
                for name, (value, text, choices) in ARGUMENTS.items()
            ),
            OpaqueFunction(function=show),
        ]
    )
