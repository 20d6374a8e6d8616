"""The executable static_transform_publisher: one latched transform on /tf_static."""

import math
import random
import string
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

from arm_description.errors import DescriptionError, SettingsError
from arm_description.transforms import quaternion_from_rpy
from arm_node.parameter_values import ParameterValueError
from arm_node.process import NodeProcess, run_process
from arm_node.setting import read_settings, setting

if TYPE_CHECKING:
    from rclpy.node import Node

USAGE = (
    "static_transform_publisher [--x X] [--y Y] [--z Z] "
    "[--qx QX] [--qy QY] [--qz QZ] [--qw QW] [--roll R] [--pitch P] [--yaw Y] "
    "--frame-id FRAME --child-frame-id CHILD, lengths in m and angles in rad"
)
EULER, QUATERNION = ("roll", "pitch", "yaw"), ("qx", "qy", "qz", "qw")
FRAMES = ("frame_id", "child_frame_id")
POSITIONAL = {
    8: ("x", "y", "z", "yaw", "pitch", "roll", *FRAMES),
    9: ("x", "y", "z", *QUATERNION, *FRAMES),
}
"""What the arguments mean without options, by their number."""

Parameters = dict[str, float | str]

_POSITION = "Position of the child in the parent frame (m)"
_ORIENTATION = "Orientation of the child in the parent frame, as a quaternion"


@dataclass(frozen=True, slots=True, kw_only=True)
class _Settings:
    """The parameters; an argument sets the same value as its parameter, and wins."""

    x: float = setting(0.0, _POSITION, name="translation.x")
    y: float = setting(0.0, _POSITION, name="translation.y")
    z: float = setting(0.0, _POSITION, name="translation.z")
    qx: float = setting(0.0, _ORIENTATION, name="rotation.x")
    qy: float = setting(0.0, _ORIENTATION, name="rotation.y")
    qz: float = setting(0.0, _ORIENTATION, name="rotation.z")
    qw: float = setting(1.0, _ORIENTATION, name="rotation.w")
    frame_id: str = setting("", "The parent frame")
    child_frame_id: str = setting("", "The child frame")


def main(argv: Sequence[str] | None = None) -> int:
    """Run the process; return its exit code."""
    arguments = list(sys.argv if argv is None else argv)
    if "--help" in arguments[1:]:
        sys.stdout.write(f"usage: {USAGE}\n")
        return 0

    @contextmanager
    def application(process: NodeProcess) -> Iterator[None]:
        from rclpy.logging import get_logger
        from rclpy.utilities import remove_ros_args

        logger = get_logger("static_transform_publisher")
        given = parameters_of(remove_ros_args(arguments)[1:], logger.warning)
        process.executor.add_node(_node(given))
        yield

    return run_process(application, arguments, user_errors=(DescriptionError, ParameterValueError))


def _node(given: Mapping[str, float | str]) -> "Node":
    """Return a node that has published the transform.

    Raises:
        SettingsError: a frame is missing, both are the same, or a value is not finite.
    """
    from geometry_msgs.msg import TransformStamped
    from rclpy.node import Node
    from rclpy.parameter import Parameter
    from tf2_msgs.msg import TFMessage

    from arm_node.parameters import declare_setting
    from arm_node.qos import LATCHED

    # As in ROS: several of them run at once, and nobody names each.
    suffix = "".join(random.choices(string.ascii_letters + string.digits, k=16))
    overrides = [Parameter(name, value=value) for name, value in given.items()]
    node = Node(f"static_transform_publisher_{suffix}", parameter_overrides=overrides)
    settings = read_settings(_Settings, partial(declare_setting, node))
    parent, child = settings.frame_id, settings.child_frame_id
    if not parent or not child:
        raise SettingsError(f"--frame-id and --child-frame-id are needed; usage: {USAGE}")
    if parent == child:
        raise SettingsError(f"a frame cannot be its own parent: both are {parent!r}")
    position = [settings.x, settings.y, settings.z]
    rotation = unit_quaternion([settings.qx, settings.qy, settings.qz, settings.qw])

    message = TransformStamped(child_frame_id=child)
    message.header.frame_id = parent
    message.header.stamp = node.get_clock().now().to_msg()
    for target, names, numbers in (
        (message.transform.translation, "xyz", position),
        (message.transform.rotation, "xyzw", rotation),
    ):
        for name, number in zip(names, numbers, strict=True):
            setattr(target, name, number)
    node.create_publisher(TFMessage, "/tf_static", LATCHED).publish(TFMessage(transforms=[message]))
    node.get_logger().info(
        "Spinning until stopped - publishing transform\n"
        f"translation: ({', '.join(f'{number:f}' for number in position)})\n"
        f"rotation: ({', '.join(f'{number:f}' for number in rotation)})\n"
        f"from '{parent}' to '{child}'"
    )
    return node


def parameters_of(words: Sequence[str], warn: Callable[[str], object]) -> Parameters:
    """Return the node's parameters that the arguments set.

    Args:
        words: the arguments without the program's name and without ROS's own.
        warn: takes the warning about the notation without options.

    Raises:
        SettingsError: an argument is unknown, is not a number, or lacks its value.
    """
    if not words:
        return {}
    if words[0].startswith("--"):
        return _parameters(_by_option(words))
    if len(words) not in POSITIONAL:
        raise SettingsError(
            f"{len(words)} arguments; without options there are eight, x y z yaw pitch roll "
            f"FRAME CHILD, or nine, x y z qx qy qz qw FRAME CHILD; with options: {USAGE}"
        )
    warn("Old-style arguments are deprecated; see --help for new-style arguments")
    return _parameters(dict(zip(POSITIONAL[len(words)], words, strict=True)))


def unit_quaternion(quaternion: Sequence[float]) -> list[float]:
    """Return x, y, z, w with length 1.

    Raises:
        SettingsError: the quaternion has no direction.
    """
    length = math.hypot(*quaternion)
    if not (math.isfinite(length) and length > 0.0):
        raise SettingsError(f"the rotation {list(quaternion)} is not a quaternion: its length is 0")
    return [component / length for component in quaternion]


def _by_option(words: Sequence[str]) -> dict[str, str]:
    known = {name.replace("_", "-") for names in POSITIONAL.values() for name in names}
    values: dict[str, str] = {}
    rest = iter(words)
    for word in rest:
        name, equals, value = word.removeprefix("--").partition("=")
        if not word.startswith("--") or name not in known:
            raise SettingsError(f"unknown argument {word!r}; usage: {USAGE}")
        if not equals:
            value = next(rest, "")
        if not value:
            raise SettingsError(f"--{name} lacks its value")
        values[name.replace("-", "_")] = value
    if not values.keys().isdisjoint(EULER) and not values.keys().isdisjoint(QUATERNION):
        raise SettingsError("give the rotation as roll, pitch, yaw or as a quaternion, not as both")
    return values


def _parameters(values: Mapping[str, str]) -> Parameters:
    numbers = {name: _number(name, text) for name, text in values.items() if name not in FRAMES}
    found: Parameters = {f"translation.{axis}": numbers[axis] for axis in "xyz" if axis in numbers}
    if not numbers.keys().isdisjoint(EULER):
        rotation = quaternion_from_rpy([numbers.get(name, 0.0) for name in EULER])
        found.update({f"rotation.{a}": float(q) for a, q in zip("xyzw", rotation, strict=True)})
    found.update({f"rotation.{name[1]}": numbers[name] for name in QUATERNION if name in numbers})
    found.update({name: values[name] for name in FRAMES if name in values})
    return found


def _number(name: str, text: str) -> float:
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise SettingsError(f"{name} is {text!r}, not a finite number; usage: {USAGE}")
    return number


if __name__ == "__main__":
    sys.exit(main())
