"""The units of numbers in messages, where REP 103 or the message's definition fixes them."""

import re
from collections.abc import Mapping

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
