"""Shows a robot without physics, for other launch files: frames, joint states, RViz."""

import os
import shutil

from launch_py import (
    DeclareLaunchArgument,
    IncludeLaunchDescription,
    LaunchDescription,
    Notified,
)
from launch_py.conditions import IfCondition
from launch_py.launch_description_sources import PythonLaunchDescriptionSource
from launch_py.ros import FindPackageShare, Node, ParameterValue
from launch_py.substitutions import (
    AndSubstitution,
    Call,
    EqualsSubstitution,
    LaunchConfiguration,
    PathJoinSubstitution,
)
from launch_py.system.packages import Packages

SLIDERS = "joint_state_publisher_gui"
SWITCH = ["true", "false"]


def source_of_motion(sliders: str) -> str:
    """Return which program moves the joints: SLIDERS, the page, or none."""
    if sliders == "gui":
        return SLIDERS if SLIDERS in Packages(os.environ).names() else "page"
    return sliders


def page() -> IncludeLaunchDescription:
    """Return the page in the browser, with sliders that move the joints."""
    file = PathJoinSubstitution([FindPackageShare("arm_viewer"), "launch", "viewer.launch.py"])
    return IncludeLaunchDescription(
        PythonLaunchDescriptionSource(file),
        launch_arguments={"publish_joint_states": "true"},
        condition=IfCondition(moved_by("page")),
    )


def moved_by(source: str) -> EqualsSubstitution:
    """Return whether this program moves the joints."""
    return EqualsSubstitution(Call(source_of_motion, LaunchConfiguration("sliders")), source)


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


def rviz() -> IncludeLaunchDescription:
    """Return RViz where it is wanted, or the page in its place."""
    file = PathJoinSubstitution([FindPackageShare("arm_viewer"), "launch", "rviz.launch.py"])
    return IncludeLaunchDescription(
        PythonLaunchDescriptionSource(file),
        launch_arguments={"page_is_open": moved_by("page")},
    )


def generate_launch_description() -> LaunchDescription:
    """Return the state publisher, the source of joint states, and RViz."""
    table = {
        "robot_description": (None, "text of the URDF", None),
        "sliders": (
            "page",
            f"sliders that move the joints: page: in the browser; gui: {SLIDERS} of a ROS 2 "
            "installation, or the page's without it",
            ["page", "gui", "none"],
        ),
        "use_jsp": ("true", "publish joint states if there are no sliders", SWITCH),
        "use_rviz": (
            "true" if shutil.which("rviz2") else "false",
            "start RViz; where it is not installed, the page in its place",
            SWITCH,
        ),
        "rviz_config_file": (
            PathJoinSubstitution([FindPackageShare("arm_description"), "config/rviz/arm.rviz"]),
            "RViz configuration file",
            None,
        ),
        "fixed_frame": ("", "RViz's fixed frame; empty for the one in its file", None),
        "use_sim_time": ("false", "use simulation time", SWITCH),
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
            rviz(),
        ]
    )
