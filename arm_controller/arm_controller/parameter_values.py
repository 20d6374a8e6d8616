"""Turns the values of parameters into what a node works with.

ROS takes the type of a parameter from how the user writes it: `2` is no double, `[1, 0]` no list
of doubles. These readers accept both, and say what is wrong with anything else.
"""

import math
from array import array
from collections.abc import Sequence
from pathlib import Path
from typing import TypeGuard

from arm_controller.errors import ParameterValueError
from arm_controller.pose import JointPose

LARGEST = 1e9
"""No number may be greater: as a time it is thirty years, and ROS counts nanoseconds in 64 bits."""


def read_number(value: object, *, positive: bool = True) -> float:
    """Return a number up to `LARGEST`, above zero or, if not `positive`, zero as well.

    Raises:
        ParameterValueError: it is something else.
    """
    wanted = "a number above 0" if positive else "0 or a number above"
    if not _is_finite(value):
        raise ParameterValueError(f"must be {wanted}, not {value!r}")
    if value < 0 or (positive and value == 0):
        raise ParameterValueError(f"must be {wanted}, not {value:g}")
    if value > LARGEST:
        raise ParameterValueError(f"must be at most {LARGEST:g}, not {value:g}")
    return float(value)


def read_rate(value: object) -> float:
    """Return how often something happens per second, 0 for never; its period is up to `LARGEST`.

    Raises:
        ParameterValueError: it is something else.
    """
    rate = read_number(value, positive=False)
    least = 1.0 / LARGEST
    if 0.0 < rate < least:
        raise ParameterValueError(f"must be 0 or at least {least:g}, not {rate:g}")
    return rate


def read_pose(value: object, joint_names: Sequence[str]) -> JointPose | None:
    """Return a pose, or None for a parameter that is not set.

    A text is as good as the list that it shows: ROS has no list of integers and doubles together,
    and its command line sends `[1, 0.5, 0, 0]` as a text.

    Raises:
        ParameterValueError: it is no list.
        PoseError: it is a list, but no pose.
    """
    if value is None:
        return None
    values = _numbers_in(value) if isinstance(value, str) else value
    # What comes through the parameter service is an array.
    if not isinstance(values, (list, tuple, array)):
        raise ParameterValueError(f"must be a list of {len(joint_names)} numbers, not {value!r}")
    return JointPose.of(joint_names, values)


def read_joint_names(value: object) -> tuple[str, ...]:
    """Return a list of one or more different names.

    Raises:
        ParameterValueError: it is something else.
    """
    names = tuple(value) if isinstance(value, (list, tuple)) else ()
    if not names or not all(isinstance(name, str) and name for name in names):
        raise ParameterValueError(f"must be a list of joint names, not {value!r}")
    if len(set(names)) != len(names):
        raise ParameterValueError(f"names a joint twice: {', '.join(names)}")
    return names


def read_place(value: object) -> tuple[float, float]:
    """Return a place on the ground, x and y.

    Raises:
        ParameterValueError: it is not a list of two finite numbers.
    """
    values = _numbers_in(value) if isinstance(value, str) else value
    if isinstance(values, (list, tuple, array)) and len(values) == 2:
        x, y = values
        if all(_is_finite(number) for number in (x, y)):
            return float(x), float(y)
    raise ParameterValueError(f"must be a list of two numbers, x and y, not {value!r}")


def read_prefix(value: object) -> str:
    """Return what stands before every name, maybe nothing.

    Raises:
        ParameterValueError: it is not a text.
    """
    if not isinstance(value, str):
        raise ParameterValueError(f"must be a text, not {value!r}")
    return value


def read_flag(value: object) -> bool:
    """Return true or false.

    Raises:
        ParameterValueError: it is something else.
    """
    if not isinstance(value, bool):
        raise ParameterValueError(f"must be true or false, not {value!r}")
    return value


def read_topic(value: object) -> str:
    """Return the name of a topic.

    Raises:
        ParameterValueError: it is not a text or an empty one.
    """
    if not isinstance(value, str) or not value:
        raise ParameterValueError(f"must be the name of a topic, not {value!r}")
    return value


def read_path(value: object) -> Path:
    """Return the path of a file, `~` expanded; whether the file is there is not asked.

    Raises:
        ParameterValueError: it is not a text or an empty one.
    """
    if not isinstance(value, str) or not value:
        raise ParameterValueError(f"must be the path of a file, not {value!r}")
    return Path(value).expanduser()


def _is_finite(value: object) -> TypeGuard[float]:
    return isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)


def _numbers_in(text: str) -> list[float] | None:
    words = text.strip()
    if not (words.startswith("[") and words.endswith("]")):
        return None
    try:
        return [float(word) for word in words[1:-1].split(",")]
    except ValueError:
        return None
