"""The transform that static_transform_publisher gets as arguments, in both of ROS's notations."""

import math
from collections.abc import Callable, Mapping, Sequence

from arm_description.errors import SettingsError
from arm_description.transforms import quaternion_from_rpy

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
