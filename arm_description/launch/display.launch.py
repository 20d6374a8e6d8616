"""Shows any robot without physics, with the page in the browser, whose sliders move it."""

from launch_py import (
    DeclareLaunchArgument,
    IncludeLaunchDescription,
    LaunchDescription,
)
from launch_py.launch_description_sources import PythonLaunchDescriptionSource
from launch_py.ros import FindPackageShare
from launch_py.substitutions import Call, LaunchConfiguration, PathJoinSubstitution

FRONT = "front"


def describe(model: str, model_args: str, camera: str) -> str:
    """Return the URDF text of the model."""
    from arm_description.xacro.expansion import arguments_of_text, expand_xacro

    # The model chooses the default: another model may have other values of that name.
    cameras = {} if camera == FRONT else {"camera": camera}
    return expand_xacro(model, cameras | arguments_of_text(model_args))


def sliders(viewer: str) -> str:
    """Return which sliders move the joints."""
    return "page" if viewer == "true" else "none"


def generate_launch_description() -> LaunchDescription:
    """Return the state publisher, the source of joint states, the page and RViz."""
    share = FindPackageShare("arm_description")
    table = {
        "model": (
            PathJoinSubstitution([share, "urdf", "arm.urdf.xacro"]),
            "URDF or xacro file",
            None,
        ),
        "model_args": ("", 'arguments of a xacro model: "a:=1 b:=2"', None),
        "camera": (FRONT, "the arm's camera", [FRONT, "side", "none"]),
        "viewer": (
            "true",
            "open the page in the browser; false: joint_state_publisher instead",
            ["true", "false"],
        ),
    }
    return LaunchDescription(
        [
            *(
                DeclareLaunchArgument(name, default_value=value, description=text, choices=choices)
                for name, (value, text, choices) in table.items()
            ),
            IncludeLaunchDescription(
                PythonLaunchDescriptionSource(
                    PathJoinSubstitution([share, "launch", "robot_view.launch.py"])
                ),
                launch_arguments={
                    "robot_description": Call(
                        describe,
                        *map(LaunchConfiguration, ("model", "model_args", "camera")),
                    ),
                    "sliders": Call(sliders, LaunchConfiguration("viewer")),
                },
            ),
        ]
    )
