"""Numbers in messages, by paths such as `position[j0]` and `pose.position.x`.

An element of an array is named by its index or by its name: joints by the array of names beside
it, as in JointState, or around it, as in a controller's state; messages by their own names. Units
are known where REP 103 or the message's definition fixes them. This module needs no ROS: a message
is whatever lists its fields.
"""

import math
import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from arm_viewer.errors import BrowserMessageError

NAME_ARRAYS = ("name", "joint_names", "interface_names", "names")
"""Fields with the names of the elements of the arrays beside them."""
OWN_NAMES = ("name", "child_frame_id", "joint_name")
"""Fields with the name of a message in an array."""
MAX_LISTED = 64
"""Elements of an array that are offered; others can be asked for by their index."""

_TOPIC = re.compile(r"/[^.\[\]]*")
_STEP = re.compile(r"\.([A-Za-z_]\w*)|\[([^\[\]]+)\]")
_TIME = ("sec", "nanosec")

_OF_FIELDS = tuple(
    (re.compile(pattern), unit)
    for pattern, unit in (
        (r"accel\w*\.angular\.[xyz]$", "rad/s²"),
        (r"accel\w*\.linear\.[xyz]$|linear_acceleration\.[xyz]$", "m/s²"),
        (r"(^|\.)angular(_velocity)?\.[xyz]$", "rad/s"),
        (r"(^|\.)linear\.[xyz]$", "m/s"),
        (r"(^|\.)(position|translation|point)\.[xyz]$", "m"),
        (r"(^|\.)force\.[xyz]$", "N"),
        (r"(^|\.)torque\.[xyz]$", "N m"),
        (r"(^|\.)(stamp|time_from_start|clock)$", "s"),
        (r"(^|\.)voltage$", "V"),
        (r"(^|\.)current$", "A"),
        (r"(^|\.)temperature$", "°C"),
        (r"(^|\.)fluid_pressure$", "Pa"),
        (r"(^|\.)ranges?(\[\d+\])?$", "m"),
    )
)
_OF_JOINTS = {
    "position": ("rad", "m"),
    "velocity": ("rad/s", "m/s"),
    "acceleration": ("rad/s²", "m/s²"),
    "effort": ("N m", "N"),
}
"""Units of a joint that turns, and of one that slides."""
_PLURALS = {"positions": "position", "velocities": "velocity", "accelerations": "acceleration"}
_OF_A_JOINT = (
    re.compile(r"(?:^|\.)(?P<quantity>\w+)\[(?P<joint>[^\[\]]+)\]$"),
    re.compile(r"\[(?P<joint>[^\[\]]+)\]\.values\[(?P<quantity>\w+)\]$"),
    re.compile(r"\[\w+_interface\.(?P<joint>[^\[\]/]+)/(?P<quantity>\w+)\]\.value$"),
)
"""In JointState and its kin, DynamicJointState, and the introspection data of ros2_control."""

_Steps = tuple[str, ...]
Read = Callable[[Any], float]


@dataclass(frozen=True, slots=True)
class NumberPath:
    """The way to a number in the messages of a topic.

    Attributes:
        topic: absolute name.
        steps: the way to it: names of fields, and of elements in brackets or their indices.
    """

    topic: str
    steps: tuple[str, ...]

    @property
    def path(self) -> str:
        """The way as it is written."""
        return "".join(self.steps).removeprefix(".")


def parse_curve(text: str) -> NumberPath:
    """Return the curve that a text such as "/joint_states.position[j0]" names.

    Raises:
        BrowserMessageError: it does not name one.
    """
    topic = _TOPIC.match(text)
    steps: list[str] = []
    at = topic.end() if topic else 0
    while topic and (step := _STEP.match(text, at)):
        steps.append(step[0])
        at = step.end()
    if not steps or at != len(text):
        raise BrowserMessageError(
            f"'{text}' is not a number of a topic; one is '/joint_states.position[j0]'"
        )
    return NumberPath(text[: topic.end() if topic else 0], tuple(steps))


def reader(curve: NumberPath) -> Read:
    """Return a function that reads the curve's number from a message; NaN if it is not there."""
    steps = tuple(_Step(text) for text in curve.steps)

    def read(message: Any) -> float:
        owners: list[Any] = []
        value: Any = message
        for step in steps:
            value = step.take(value, owners)
            if value is None:
                return math.nan
        return _number(value)

    return read


def numbers_in(message: Any) -> Iterator[str]:
    """Yield the paths of all numbers in a message, without times of stamps."""
    for steps in _listed(message, (), ()):
        yield "".join(steps).removeprefix(".")


def unit_of(path: str, slides: Mapping[str, bool]) -> str:
    """Return the unit of a number; empty if it is not known or there is none.

    Args:
        path: of the number in its message, such as "position[j0]".
        slides: whether a joint slides instead of turning, by name.
    """
    for pattern in _OF_A_JOINT:
        found = pattern.search(path)
        if found and found["joint"] in slides:
            quantity = _PLURALS.get(found["quantity"], found["quantity"])
            return _OF_JOINTS.get(quantity, ("", ""))[slides[found["joint"]]]
    return next((unit for pattern, unit in _OF_FIELDS if pattern.search(path)), "")


class _Step:
    """One step; it remembers at which index it last found its element."""

    def __init__(self, text: str) -> None:
        self._is_field = text.startswith(".")
        self._name = text[1:] if self._is_field else text[1:-1]
        self._index = int(self._name) if self._name.isdecimal() else None
        self._found = 0

    def take(self, value: Any, owners: list[Any]) -> Any:
        """Return what the step leads to, or None; `owners` are the messages around it."""
        if self._is_field:
            owners.append(value)
            return getattr(value, self._name, None) if _is_message(value) else None
        if _is_message(value) or not hasattr(value, "__len__") or isinstance(value, str):
            return None
        index = self._index
        if index is None or (index >= len(value)):
            index = self._named(value, owners)
        return value[index] if index is not None else None

    def _named(self, value: Any, owners: list[Any]) -> int | None:
        names = _element_names(value, owners)
        if self._found >= len(names) or names[self._found] != self._name:
            if self._name not in names:
                return None
            self._found = names.index(self._name)
        return self._found


def _listed(
    value: Any, steps: tuple[str, ...], owners: tuple[Any, ...]
) -> Iterator[tuple[str, ...]]:
    if not math.isnan(_number(value, missing=0.0)):
        yield steps
    elif _is_message(value):
        for name in value.get_fields_and_field_types():
            if name != "stamp":
                yield from _listed(getattr(value, name), (*steps, f".{name}"), (*owners, value))
    elif not isinstance(value, str | bytes) and not _is_blob(value):
        names = _element_names(value, list(owners))
        for index in range(min(len(value), MAX_LISTED)):
            name = names[index] if names else str(index)
            yield from _listed(value[index], (*steps, f"[{name}]"), owners)


def _element_names(value: Any, owners: list[Any]) -> list[str]:
    """Return the names of the elements of an array; none if they have none, or ambiguous ones."""
    count = len(value)
    for owner in reversed(owners):
        for field in NAME_ARRAYS:
            names = getattr(owner, field, None)
            if names is not value and isinstance(names, list) and len(names) == count:
                return names if _are_names(names) else []
    for field in OWN_NAMES:
        if count and all(hasattr(element, field) for element in value):
            names = [getattr(element, field) for element in value]
            return names if _are_names(names) else []
    return []


def _are_names(names: list[Any]) -> bool:
    return (
        bool(names)
        and all(isinstance(n, str) and n and not set(n) & set("[]") for n in names)
        and len(set(names)) == len(names)
    )


def _is_blob(value: Any) -> bool:
    """Return whether these are bytes, such as those of a picture."""
    return getattr(value, "typecode", "") == "B" and len(value) > MAX_LISTED


def _is_message(value: Any) -> bool:
    return hasattr(value, "get_fields_and_field_types")


def _number(value: Any, missing: float = math.nan) -> float:
    """Return a number, a flag or a time in s as a float; NaN for anything else.

    Args:
        value: of a field.
        missing: what a NaN that is there becomes.
    """
    if _is_message(value):
        if tuple(value.get_fields_and_field_types()) != _TIME:
            return math.nan
        return value.sec + 1e-9 * value.nanosec
    if isinstance(value, str | bytes) or hasattr(value, "__len__"):
        return math.nan
    number = float(value)
    return missing if math.isnan(number) else number
