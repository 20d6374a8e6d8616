"""The ROSMASTER X3 without physics: its frames, sliders for its wheels, and RViz."""

from launch_py import DeclareLaunchArgument, IncludeLaunchDescription, LaunchDescription
from launch_py.launch_description_sources import PythonLaunchDescriptionSource
from launch_py.ros import FindPackageShare
from launch_py.substitutions import Call, LaunchConfiguration, PathJoinSubstitution

SWITCH = ["true", "false"]
XACRO_ARGUMENTS = {
    "prefix": ("", "prefix of every link and joint name", None),
    "use_gazebo": ("false", "use the simulation as hardware instead of a mock", SWITCH),
}


def describe(model: str, *values: str) -> str:
    """Return the URDF text of the model, given the values of XACRO_ARGUMENTS."""
    from arm_description.xacro.expansion import expand_xacro

    return expand_xacro(model, dict(zip(XACRO_ARGUMENTS, values, strict=True)))


def sliders(jsp_gui: str) -> str:
    """Return which sliders move the wheels."""
    return "gui" if jsp_gui == "true" else "none"


def arguments() -> list[DeclareLaunchArgument]:
    """Return the declarations."""
    share = FindPackageShare("yahboom_rosmaster_description")
    model = [LaunchConfiguration("robot_name"), ".urdf.xacro"]
    table = {
        "robot_name": ("rosmaster_x3", "robot of this package", None),
        **XACRO_ARGUMENTS,
        "urdf_model": (
            PathJoinSubstitution([share, "urdf", "robots", model]),
            "URDF or xacro file",
            None,
        ),
        "rviz_config_file": (
            PathJoinSubstitution([share, "config/rviz/yahboom_rosmaster_description.rviz"]),
            "RViz configuration",
            None,
        ),
        "jsp_gui": (
            "true",
            "show sliders for the wheels: joint_state_publisher_gui if ROS 2 is installed, or else "
            "the page",
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
                    "fixed_frame": [LaunchConfiguration("prefix"), "base_link"],
                },
            ),
        ]
    )
