"""The arm's description without a simulation, as in ROS 1: /robot_description and its frames."""

from collections.abc import Sequence

from arm_control.course import HARDWARE_INTERFACE_ARGUMENT
from launch_py import Action, DeclareLaunchArgument, LaunchDescription, Notified
from launch_py.actions import OpaqueFunction
from launch_py.errors import UsageError
from launch_py.launch_context import LaunchContext
from launch_py.ros import FindPackageShare, Node
from launch_py.substitutions import PathJoinSubstitution

ORIGIN = "0 0 0"


def numbers(text: str, name: str) -> Sequence[float]:
    """Return three numbers separated by blanks.

    Raises:
        UsageError: the text is not three numbers.
    """
    try:
        x, y, z = map(float, text.split())
    except ValueError:
        raise UsageError(f"{name}:={text!r} is not three numbers, as in {ORIGIN!r}") from None
    return (x, y, z)


def upload(context: LaunchContext) -> list[Action]:
    """Return the state publisher with the description, placed in the world if requested."""
    from arm_description.xacro.expansion import expand_xacro
    from arm_gazebo.launching.edited_description import placed

    words = context.launch_configurations
    pose = [
        *numbers(words["origin_xyz"], "origin_xyz"),
        *numbers(words["origin_rpy"], "origin_rpy"),
    ]
    description = expand_xacro(words["model"])
    if any(pose):
        description = placed(description, pose)
    return [
        Node(
            package="arm_description",
            executable="robot_state_publisher",
            namespace=words["robot_name"],
            parameters=[{"robot_description": description}],
            ready=Notified(),
        )
    ]


def generate_launch_description() -> LaunchDescription:
    """Return the state publisher of the arm."""
    model = PathJoinSubstitution([FindPackageShare("arm_description"), "urdf", "arm.urdf.xacro"])
    table = {
        "model": (model, "URDF or xacro file"),
        "robot_name": ("", "namespace of the description's topic"),
        "origin_xyz": (ORIGIN, "position of the base in the world, in m"),
        "origin_rpy": (ORIGIN, "roll, pitch and yaw of the base in the world, in rad"),
    }
    return LaunchDescription(
        [
            *(
                DeclareLaunchArgument(name, default_value=value, description=text)
                for name, (value, text) in table.items()
            ),
            DeclareLaunchArgument("hardware_interface", **HARDWARE_INTERFACE_ARGUMENT),
            OpaqueFunction(function=upload),
        ]
    )
