"""Any robot by its URDF or xacro file, with sliders for its joints: model:=FILE."""

from launch_py import DeclareLaunchArgument, IncludeLaunchDescription, LaunchDescription
from launch_py.launch_description_sources import PythonLaunchDescriptionSource
from launch_py.ros import FindPackageShare
from launch_py.substitutions import Call, LaunchConfiguration, PathJoinSubstitution

SWITCH = ["true", "false"]


def describe(model: str) -> str:
    """Return the URDF text of the model."""
    from arm_description.xacro.expansion import expand_xacro

    return expand_xacro(model)


def sliders(jsp_gui: str) -> str:
    """Return which sliders move the joints."""
    return "gui" if jsp_gui == "true" else "none"


def generate_launch_description() -> LaunchDescription:
    """Return robot_view.launch.py with this robot."""
    share = FindPackageShare("arm_description")
    view = PathJoinSubstitution([share, "launch", "robot_view.launch.py"])
    table = {
        "model": (
            PathJoinSubstitution([share, "urdf", "arm.urdf.xacro"]),
            "URDF or xacro file",
            None,
        ),
        "jsp_gui": ("true", "show sliders: joint_state_publisher_gui, or else the page", SWITCH),
        "rvizconfig": (
            PathJoinSubstitution([share, "config", "rviz", "arm.rviz"]),
            "RViz configuration",
            None,
        ),
    }
    return LaunchDescription(
        [
            *(
                DeclareLaunchArgument(name, default_value=value, description=text, choices=choices)
                for name, (value, text, choices) in table.items()
            ),
            IncludeLaunchDescription(
                PythonLaunchDescriptionSource(view),
                launch_arguments={
                    "robot_description": Call(describe, LaunchConfiguration("model")),
                    "sliders": Call(sliders, LaunchConfiguration("jsp_gui")),
                    "rviz_config_file": LaunchConfiguration("rvizconfig"),
                },
            ),
        ]
    )
