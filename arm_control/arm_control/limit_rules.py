"""What commands of each kind may be, given the limits and states of their joints."""

from typing import Protocol

import numpy as np

from arm_control.joint_group import Band, JointGroup, Values


class LimitRule(Protocol):
    """Bounds of the next commands of one kind."""

    def band(self, commands: Values, previous: Values, period_s: float) -> Band:
        """Return the lowest and the highest command; the lowest is never the higher one.

        Args:
            commands: what is to be commanded; a bound depends on it only where neither the last
                command nor the state is known.
            previous: what was commanded in the last cycle, NaN for nothing.
            period_s: length of the cycle, above 0.
        """
        ...


class PositionLimits:
    """Between the bounds, and no further from the last command than the speed limit allows."""

    def __init__(self, group: JointGroup) -> None:
        self._group = group

    def band(self, commands: Values, previous: Values, period_s: float) -> Band:
        """Return the lowest and the highest position."""
        group = self._group
        speed = group.velocity
        if group.limits_acceleration:
            # The joint cannot be faster in the next cycle than it is, plus what it can gain.
            present = np.nan_to_num(np.abs(group.velocities()))
            speed = np.minimum(speed, present + group.acceleration * period_s)
        origin = _origin(previous, group.positions(), commands)
        low, high = group.soft_velocities(origin)
        low = origin + np.maximum(low, -speed) * period_s
        high = origin + np.minimum(high, speed) * period_s
        # A soft bound is not stepped over, nor does a joint beyond it jump back.
        low = np.maximum(low, np.minimum(group.soft_lower, origin))
        high = np.minimum(high, np.maximum(group.soft_upper, origin))
        return _clipped(low, group.lower, group.upper), _clipped(high, group.lower, group.upper)


class VelocityLimits:
    """Below the speed limit, and never so fast that the next cycle ends beyond a bound."""

    def __init__(self, group: JointGroup) -> None:
        self._group = group

    def band(self, commands: Values, previous: Values, period_s: float) -> Band:
        """Return the lowest and the highest velocity; a joint beyond a bound may only go back."""
        group = self._group
        positions = group.positions()
        low, high = group.soft_velocities(positions)
        # fmin and fmax pass over the NaN of a position that nobody knows.
        low = np.fmax(low, np.minimum((group.lower - positions) / period_s, 0.0))
        high = np.fmin(high, np.maximum((group.upper - positions) / period_s, 0.0))
        if not group.limits_acceleration:
            return low, high
        origin = _origin(previous, group.velocities(), commands)
        step = group.acceleration * period_s
        # Clipped, not intersected: before a bound a joint must brake harder than it may.
        return _clipped(origin - step, low, high), _clipped(origin + step, low, high)


class EffortLimits:
    """Below the effort limit, and not outwards at a position bound or beyond the speed limit."""

    def __init__(self, group: JointGroup) -> None:
        self._group = group

    def band(self, commands: Values, previous: Values, period_s: float) -> Band:
        """Return the lowest and the highest effort."""
        group = self._group
        positions, velocities = group.positions(), group.velocities()
        # A comparison with NaN is false: what nobody knows limits nothing.
        low_end = ((positions <= group.lower) & (velocities <= 0.0)) | (
            velocities < -group.velocity
        )
        high_end = ((positions >= group.upper) & (velocities >= 0.0)) | (
            velocities > group.velocity
        )
        low = np.where(low_end, 0.0, -group.effort)
        high = np.where(high_end, 0.0, group.effort)
        if not group.k_velocity.any():
            return low, high
        slowest, fastest = group.soft_velocities(positions)
        soft_low = group.k_velocity * (slowest - velocities)
        soft_high = group.k_velocity * (fastest - velocities)
        soft = (group.k_velocity > 0.0) & np.isfinite(velocities)
        return (
            _clipped(np.where(soft, soft_low, low), low, high),
            _clipped(np.where(soft, soft_high, high), low, high),
        )


class SymmetricLimits:
    """Below a bound, both ways."""

    def __init__(self, bound: Values) -> None:
        self._band = (-bound, bound)

    def band(self, commands: Values, previous: Values, period_s: float) -> Band:
        """Return the lowest and the highest command."""
        return self._band


def rule_for(kind: str, group: JointGroup) -> LimitRule:
    """Return the rule for commands of a kind, one of `arm_control.joint_limits.LIMITED`."""
    match kind:
        case "position":
            return PositionLimits(group)
        case "velocity":
            return VelocityLimits(group)
        case "effort":
            return EffortLimits(group)
        case "acceleration":
            return SymmetricLimits(group.acceleration)
        case _:
            return SymmetricLimits(group.jerk)


def _origin(previous: Values, states: Values, commands: Values) -> Values:
    """Return from where a change is counted: the last command, else the state, else the command.

    The last command goes before the state, which lags behind it: counted from the state, the
    speed limit would be that of a joint which never catches up.
    """
    unknown = np.isnan(previous)
    if not unknown.any():
        return previous
    origin = np.where(unknown, states, previous)
    # Where nothing is known, not even a finite command, any number will do.
    return np.where(np.isnan(origin), np.nan_to_num(commands), origin)


def _clipped(values: Values, low: Values, high: Values) -> Values:
    """Return what np.clip does, in a fifth of its time for a handful of joints."""
    return np.minimum(np.maximum(values, low), high)
