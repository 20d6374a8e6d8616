"""Reads URDF's <joint>: type, frame, axis, limits and mimic."""

import math

from arm_description.urdf.element import UrdfElement
from arm_description.urdf.joint_type import JointType
from arm_description.urdf.mimic import Mimic
from arm_description.urdf.robot import (
    Dynamics,
    Joint,
    JointLimit,
    SafetyLimits,
    Vector,
)

_DEFAULT_AXIS: Vector = (1.0, 0.0, 0.0)


def read_joint(element: UrdfElement) -> Joint:
    """Read a <joint>.

    Raises:
        UrdfError: naming element and line.
    """
    name = element.needed_text("name")
    element = element.named(name)
    kind = _read_type(element)
    return Joint(
        name=name,
        type=kind,
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


def _read_type(element: UrdfElement) -> JointType:
    name = element.needed_text("type")
    try:
        return JointType(name)
    except ValueError:
        raise element.error(f"has type '{name}'; the types are {', '.join(JointType)}") from None


def _read_axis(element: UrdfElement, kind: JointType) -> Vector:
    axis = element.child("axis")
    if axis is None or not kind.has_axis:
        return _DEFAULT_AXIS
    x, y, z = axis.vector("xyz", _DEFAULT_AXIS)
    # hypot does not overflow or underflow like the sum of squares.
    length = math.hypot(x, y, z)
    if not 0.0 < length < math.inf:
        raise axis.error(f"is '{axis.text('xyz', '')}', which is not a direction")
    return x / length, y / length, z / length


def _read_limit(element: UrdfElement, kind: JointType) -> JointLimit | None:
    limit = element.child("limit")
    if limit is None:
        if kind.needs_limit:
            raise element.error(f"is {kind} and needs a <limit>")
        return None
    if not kind.is_scalar:
        return None
    lower, upper = -math.inf, math.inf
    if kind.needs_limit:
        lower, upper = limit.number("lower", 0.0), limit.number("upper", 0.0)
    if lower > upper:
        limit.warn(f"has lower={lower:g} above upper={upper:g}; they are swapped")
        lower, upper = upper, lower
    return JointLimit(lower, upper, _read_bound(limit, "effort"), _read_bound(limit, "velocity"))


def _read_bound(limit: UrdfElement, attribute: str) -> float:
    """Return the effort or velocity limit; 0 means no limit, as in ros2_control."""
    value = limit.number(attribute)
    if value < 0.0:
        limit.warn(f"has {attribute}={value:g}; a negative number sets no limit")
    return max(value, 0.0)


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
    # An attribute must be finite, so -inf can only be the default.
    return SafetyLimits(
        soft_lower=safety.number("soft_lower_limit", -math.inf),
        soft_upper=safety.number("soft_upper_limit", math.inf),
        k_position=safety.number("k_position", 0.0),
        k_velocity=safety.number("k_velocity", 0.0),
    )
