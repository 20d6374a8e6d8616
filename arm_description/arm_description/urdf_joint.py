"""URDF's <joint>: type, frame, axis, limits and what it mimics."""

import math
from typing import cast, get_args

from arm_description.robot import (
    Dynamics,
    Joint,
    JointLimit,
    JointType,
    Mimic,
    SafetyLimits,
    Vector,
)
from arm_description.urdf_element import UrdfElement

_TYPES: tuple[str, ...] = get_args(JointType)
_NEED_AN_AXIS = ("revolute", "continuous", "prismatic", "planar")
_NEED_A_LIMIT = ("revolute", "prismatic")
_DEFAULT_AXIS: Vector = (1.0, 0.0, 0.0)


def read_joint(element: UrdfElement) -> Joint:
    """Read a <joint>.

    Raises:
        UrdfError: naming element and line.
    """
    name = element.needed_text("name")
    element = element.named(name)
    kind = element.needed_text("type")
    if kind not in _TYPES:
        raise element.error(f"has type '{kind}'; the types are {', '.join(_TYPES)}")
    return Joint(
        name=name,
        type=cast(JointType, kind),
        parent=element.needed_child("parent").needed_text("link"),
        child=element.needed_child("child").needed_text("link"),
        origin=element.origin(),
        axis=_read_axis(element, kind),
        limit=_read_limit(element, kind),
        dynamics=_read_dynamics(element),
        mimic=_read_mimic(element),
        safety=_read_safety(element),
        line=element.line,
    )


def _read_axis(element: UrdfElement, kind: str) -> Vector:
    axis = element.child("axis")
    if axis is None or kind not in _NEED_AN_AXIS:
        return _DEFAULT_AXIS
    x, y, z = axis.vector("xyz", _DEFAULT_AXIS)
    # hypot neither overflows nor underflows where the sum of squares would.
    length = math.hypot(x, y, z)
    if not 0.0 < length < math.inf:
        raise axis.error(f"is '{axis.text('xyz', '')}', which is no direction")
    return x / length, y / length, z / length


def _read_limit(element: UrdfElement, kind: str) -> JointLimit | None:
    limit = element.child("limit")
    if limit is None:
        if kind in _NEED_A_LIMIT:
            raise element.error(f"is {kind} and needs a <limit>")
        return None
    if kind not in (*_NEED_A_LIMIT, "continuous"):
        return None
    lower, upper = -math.inf, math.inf
    if kind in _NEED_A_LIMIT:
        lower, upper = limit.number("lower", 0.0), limit.number("upper", 0.0)
    if lower > upper:
        raise limit.error(f"has lower={lower:g} above upper={upper:g}")
    return JointLimit(lower, upper, limit.size("effort"), limit.size("velocity"))


def _read_dynamics(element: UrdfElement) -> Dynamics:
    dynamics = element.child("dynamics")
    if dynamics is None:
        return Dynamics()
    return Dynamics(dynamics.number("damping", 0.0), dynamics.number("friction", 0.0))


def _read_mimic(element: UrdfElement) -> Mimic | None:
    mimic = element.child("mimic")
    if mimic is None:
        return None
    return Mimic(
        mimic.needed_text("joint"), mimic.number("multiplier", 1.0), mimic.number("offset", 0.0)
    )


def _read_safety(element: UrdfElement) -> SafetyLimits | None:
    safety = element.child("safety_controller")
    if safety is None:
        return None
    # -inf as a default is no attribute's value, so it cannot come from the text.
    return SafetyLimits(
        soft_lower=safety.number("soft_lower_limit", -math.inf),
        soft_upper=safety.number("soft_upper_limit", math.inf),
        k_position=safety.number("k_position", 0.0),
        k_velocity=safety.number("k_velocity", 0.0),
    )
