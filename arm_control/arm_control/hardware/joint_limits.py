"""Reads the position, velocity, effort and other limits of joints from a robot description."""

import math
from dataclasses import replace

from arm_control.errors import HardwareInfoError
from arm_control.hardware.info import InterfaceInfo, JointInfo, parse_hardware_info
from arm_description.errors import DescriptionError
from arm_description.urdf.description import Description, as_description
from arm_description.urdf.parser import ignore_remark, parse_urdf
from arm_description.urdf.robot import Joint
from arm_node.frozen import frozen

LIMITED = ("position", "velocity", "effort", "acceleration", "jerk")
"""Command interfaces that can be limited."""


@frozen
class SoftLimits:
    """A `<safety_controller>`: soft bounds within the position limits.

    Attributes:
        lower: below this position the joint may only move up.
        upper: above this position the joint may only move down.
        k_position: highest speed towards a bound per distance from it, in 1/s; 0 sets no limit.
        k_velocity: highest effort per difference from the highest speed; 0 sets no limit.
    """

    lower: float
    upper: float
    k_position: float
    k_velocity: float


NO_SOFT_LIMITS = SoftLimits(-math.inf, math.inf, 0.0, 0.0)


@frozen
class JointLimits:
    """Limits of one joint, in rad or m, s, N m or N; infinite if there is none.

    Attributes:
        lower: lowest position.
        upper: highest position.
        velocity: highest speed.
        effort: highest force or torque.
        acceleration: highest acceleration, and deceleration.
        jerk: highest jerk.
        soft: narrower position bounds.
    """

    lower: float = -math.inf
    upper: float = math.inf
    velocity: float = math.inf
    effort: float = math.inf
    acceleration: float = math.inf
    jerk: float = math.inf
    soft: SoftLimits = NO_SOFT_LIMITS


def read_joint_limits(description: Description) -> dict[str, JointLimits]:
    """Return the limits of every joint, by name.

    The URDF's `<limit>` and `<safety_controller>`, narrowed by the `min` and `max` of the joint's
    command interfaces, without what `<limits enable="false"/>` switches off. A speed or an effort
    of 0 in a `<limit>` counts as not given, because it would mean a joint that cannot move.

    Raises:
        HardwareInfoError: the description cannot be read, or allows a joint no position at all.
    """
    try:
        document = as_description(description)
        robot = parse_urdf(document, remark=ignore_remark)
        components = parse_hardware_info(document)
    except DescriptionError as error:
        raise HardwareInfoError(f"no joint limits can be read: {error}") from error
    limits = {joint.name: _urdf_limits(joint) for joint in robot.joints}
    for component in components:
        for part in component.joints:
            limits[part.name] = _with_interfaces(limits.get(part.name, JointLimits()), part)
    return limits


def _with_interfaces(limits: JointLimits, part: JointInfo) -> JointLimits:
    """Return a joint's limits, narrowed by its `<ros2_control>` block."""
    if not part.is_limited:
        return JointLimits()
    for interface in part.command_interfaces:
        limits = _narrowed(limits, interface)
    if limits.lower > limits.upper:
        raise HardwareInfoError(
            f"joint '{part.name}' has no allowed position: min and max of its command interface "
            f"'position' do not overlap the URDF's limits ({limits.lower:g} > {limits.upper:g})"
        )
    return limits


def _urdf_limits(joint: Joint) -> JointLimits:
    limit, safety = joint.limit, joint.safety
    limits = JointLimits()
    if limit is not None:
        limits = JointLimits(
            limit.lower, limit.upper, limit.velocity or math.inf, limit.effort or math.inf
        )
    if safety is not None:
        soft = SoftLimits(
            safety.soft_lower, safety.soft_upper, safety.k_position, safety.k_velocity
        )
        limits = replace(limits, soft=soft)
    return limits


def _narrowed(limits: JointLimits, interface: InterfaceInfo) -> JointLimits:
    """Return the limits, narrowed by the min and max of a command interface."""
    if interface.name not in LIMITED:
        return limits
    low = -math.inf if interface.minimum is None else interface.minimum
    high = math.inf if interface.maximum is None else interface.maximum
    if interface.name == "position":
        if not interface.is_limited:
            return replace(limits, lower=-math.inf, upper=math.inf, soft=NO_SOFT_LIMITS)
        return replace(limits, lower=max(limits.lower, low), upper=min(limits.upper, high))
    # Symmetric as in ros2_control: the tighter of min and max.
    bound = min(getattr(limits, interface.name), abs(low), abs(high))
    return replace(limits, **{interface.name: bound if interface.is_limited else math.inf})
