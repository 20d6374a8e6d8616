"""The myCobot without physics: its frames, sliders for its joints, and RViz if it is installed."""

from launch_py import DeclareLaunchArgument, IncludeLaunchDescription, LaunchDescription
from launch_py.launch_description_sources import PythonLaunchDescriptionSource
from launch_py.ros import FindPackageShare
from launch_py.substitutions import Call, LaunchConfiguration, PathJoinSubstitution

SWITCH = ["true", "false"]

XACRO_ARGUMENTS = {
    "prefix": ("", "prefix of every link and joint name", None),
    "add_world": ("true", "fix the base to a link 'world'", SWITCH),
    "base_link": ("base_link", "name of the base link", None),
    "base_type": ("g_shape", "type of the base plate", ["g_shape"]),
    "flange_link": ("link6_flange", "name of the tool flange", None),
    "gripper_type": ("adaptive_gripper", "type of the gripper", ["adaptive_gripper"]),
    "use_gazebo": ("false", "use the simulation as hardware instead of a mock", SWITCH),
    "use_gripper": ("true", "add the gripper", SWITCH),
    "use_camera": ("false", "add a depth camera on a stand", SWITCH),
}


def describe(model: str, *values: str) -> str:
    """Return the URDF text of the model, given the values of XACRO_ARGUMENTS."""
    from arm_description.xacro.expansion import expand_xacro

    return expand_xacro(model, dict(zip(XACRO_ARGUMENTS, values, strict=True)))


def sliders(jsp_gui: str) -> str:
    """Return which sliders move the joints."""
    return "gui" if jsp_gui == "true" else "none"


def arguments() -> list[DeclareLaunchArgument]:
    """Return the declarations."""
    share = FindPackageShare("mycobot_description")
    robot = LaunchConfiguration("robot_name")
    table = {
        "robot_name": ("mycobot_280", "robot of this package", None),
        **XACRO_ARGUMENTS,
        "urdf_model": (
            PathJoinSubstitution([share, "urdf", "robots", [robot, ".urdf.xacro"]]),
            "URDF or xacro file",
            None,
        ),
        "rviz_config_file": (
            PathJoinSubstitution([share, "config", "rviz", [robot, "_description.rviz"]]),
            "RViz configuration",
            None,
        ),
        "jsp_gui": (
            "true",
            "show sliders: joint_state_publisher_gui if ROS 2 is installed, or else the page",
            SWITCH,
        ),
    }
    return [
        DeclareLaunchArgument(name, default_value=default, description=text, choices=choices)
        for name, (default, text, choices) in table.items()
    ]


def generate_launch_description() -> LaunchDescription:
    """Return robot_view.launch.py with this robot."""
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
                    # The file's own fixed frame base_link does not exist with a prefix.
                    "fixed_frame": [
                        LaunchConfiguration("prefix"),
                        LaunchConfiguration("base_link"),
                    ],
                },
            ),
        ]
    )
