"""Readers for this package's parameters; see `arm_node.parameter_values`."""

from array import array
from collections.abc import Sequence
from dataclasses import dataclass
from string import Formatter

from arm_controller.joint_pose import JointPose
from arm_node.parameter_values import (
    NumberReader,
    ParameterValueError,
    numbers_in,
    read_numbers,
    read_text,
    read_texts,
    refusal,
)

MAX_NUMBER = 1e9
"""Largest allowed number: as a time it is thirty years, and ROS has 64 bits of nanoseconds."""

JOINT_FIELDS = ("name", "index", "position", "velocity", "effort")
"""What a line printed for a joint may contain in braces."""


def read_joint_format(value: object) -> str:
    """Return a format of a joint's line, whose fields are among `JOINT_FIELDS`.

    Raises:
        ParameterValueError: the value is not a text, or has other fields.
    """
    text = read_text(value)
    try:
        parts = list(Formatter().parse(text))
    except ValueError as error:
        raise ParameterValueError(f"the format '{text}' is wrong: {error}") from error
    for _, field, spec, conversion in parts:
        if field is not None and (field not in JOINT_FIELDS or spec or conversion):
            existing = ", ".join(f"{{{name}}}" for name in JOINT_FIELDS)
            raise ParameterValueError(f"the format '{text}' may contain only {existing}")
    return text


read_positive = NumberReader(f"a number above 0, at most {MAX_NUMBER:g}", 0.0, MAX_NUMBER, True)
read_zero_or_more = NumberReader(f"a number from 0 to {MAX_NUMBER:g}", 0.0, MAX_NUMBER)


@dataclass(frozen=True, slots=True)
class _RateReader(NumberReader):
    """Reads a rate in Hz, 0 for never; its period is at most `MAX_NUMBER`."""

    def __call__(self, value: object) -> float:
        """Return the rate."""
        rate = NumberReader.__call__(self, value)
        least = 1.0 / MAX_NUMBER
        if 0.0 < rate < least:
            raise refusal(f"0 or at least {least:g}", value)
        return rate


read_rate = _RateReader(read_zero_or_more.wanted, 0.0, MAX_NUMBER)


def read_pose(value: object, joint_names: Sequence[str]) -> JointPose | None:
    """Return a pose, or None for an empty list.

    Raises:
        ParameterValueError: the value is not a list.
        PoseError: the list is not a pose.
    """
    values = numbers_in(value)
    if isinstance(values, list | tuple | array) and not values:
        return None
    # The parameter service delivers an array.
    if not isinstance(values, list | tuple | array):
        raise refusal(f"a list of {len(joint_names)} numbers", value)
    return JointPose.of(joint_names, values)


def read_joint_names(value: object) -> tuple[str, ...]:
    """Return a list of unique names, at least one.

    Raises:
        ParameterValueError: the value is something else.
    """
    wanted = "a list of joint names"
    names = read_texts(value, wanted)
    if not names:
        raise refusal(wanted, value)
    if len(set(names)) != len(names):
        raise ParameterValueError(f"names a joint twice: {', '.join(names)}")
    return names


def read_place(value: object) -> tuple[float, float]:
    """Return a position on the ground, x and y.

    Raises:
        ParameterValueError: the value is not a list of two finite numbers.
    """
    wanted = "a list of two numbers, x and y"
    numbers = read_numbers(value, wanted)
    if len(numbers) != 2:
        raise refusal(wanted, value)
    return numbers[0], numbers[1]
