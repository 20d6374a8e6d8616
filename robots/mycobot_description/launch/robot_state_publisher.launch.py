"""The myCobot without physics: its frames and joint states, and RViz where there is one."""

import os

from launch_py import DeclareLaunchArgument, IncludeLaunchDescription, LaunchDescription
from launch_py.launch_description_sources import PythonLaunchDescriptionSource
from launch_py.packages import Packages
from launch_py.ros import FindPackageShare
from launch_py.substitutions import Call, LaunchConfiguration, PathJoinSubstitution

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


def sliders(jsp_gui: str) -> str:
    """Return whose sliders move the joints."""
    return "gui" if jsp_gui == "true" else "none"


def arguments() -> list[DeclareLaunchArgument]:
    """Return the declarations."""
    share = FindPackageShare("mycobot_description")
    robot = LaunchConfiguration("robot_name")
    gui = "true" if SLIDERS in Packages(os.environ).names() else "false"
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
        "jsp_gui": (gui, f"sliders: {SLIDERS} of a ROS 2 installation, or else the page", SWITCH),
    }
    return [
        DeclareLaunchArgument(name, default_value=default, description=text, choices=choices)
        for name, (default, text, choices) in table.items()
    ]


def generate_launch_description() -> LaunchDescription:
    """Return what shows any robot, told about this one."""
    view = PathJoinSubstitution(
        [FindPackageShare("arm_description"), "launch", "robot_view.launch.py"]
    )
    values = (LaunchConfiguration(name) for name in XACRO_ARGUMENTS)
    return LaunchDescription(
        [
            *arguments(),
            IncludeLaunchDescription(
                PythonLaunchDescriptionSource(view),
                launch_arguments={
                    "robot_description": Call(describe, LaunchConfiguration("urdf_model"), *values),
                    "sliders": Call(sliders, LaunchConfiguration("jsp_gui")),
                    # The file's own fixed frame is base_link: not there with a prefix.
                    "fixed_frame": [
                        LaunchConfiguration("prefix"),
                        LaunchConfiguration("base_link"),
                    ],
                },
            ),
        ]
    )
