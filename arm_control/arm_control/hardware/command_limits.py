"""Keeps commands within the limits of the joints, all joints at once."""

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from arm_control.hardware.joint_limits import LIMITED, NO_SOFT_LIMITS, JointLimits
from arm_control.hardware.resource_manager import ResourceManager

Values = NDArray[np.float64]
"""One value per joint, shape (n,)."""

Band = tuple[Values, Values]
"""The lowest and the highest allowed values, each of shape (n,)."""


class _JointGroup:
    """The limits of the joints behind n commands of one kind, and their states. Loop thread only.

    Attributes:
        lower, upper, velocity, effort, acceleration, jerk: as in `JointLimits`, shape (n,).
        soft_lower, soft_upper, k_position, k_velocity: as in `SoftLimits`, shape (n,).
        limits_acceleration: whether any of them limits its acceleration.
    """

    def __init__(
        self, limits: Sequence[JointLimits], joints: Sequence[str], resources: ResourceManager
    ) -> None:
        def of(name: str) -> Values:
            return np.array([getattr(limit, name) for limit in limits])

        def of_soft(name: str) -> Values:
            return np.array([getattr(limit.soft, name) for limit in limits])

        self.lower, self.upper = of("lower"), of("upper")
        self.velocity, self.effort = of("velocity"), of("effort")
        self.acceleration, self.jerk = of("acceleration"), of("jerk")
        self.soft_lower, self.soft_upper = of_soft("lower"), of_soft("upper")
        self.k_position, self.k_velocity = of_soft("k_position"), of_soft("k_velocity")
        self.limits_acceleration = bool(np.isfinite(self.acceleration).any())
        self._has_soft_limits = any(limit.soft != NO_SOFT_LIMITS for limit in limits)
        self._positions = _States(joints, "position", resources)
        self._velocities = _States(joints, "velocity", resources)

    def positions(self) -> Values:
        """Return the positions of the joints; NaN if unknown."""
        return self._positions.read()

    def velocities(self) -> Values:
        """Return the velocities of the joints; NaN if unknown."""
        return self._velocities.read()

    def soft_velocities(self, positions: Values) -> Band:
        """Return the lowest and the highest velocity allowed at a position.

        The speed towards a soft bound falls with the distance from it; beyond the bound the joint
        may only move back. The soft bounds of a joint whose position is unknown are ignored.
        """
        if not self._has_soft_limits:
            return -self.velocity, self.velocity
        down = np.where(positions > self.soft_lower, np.inf, 0.0)
        up = np.where(positions < self.soft_upper, np.inf, 0.0)
        # fmin ignores the NaN of 0 times infinity, for a joint without a soft bound.
        slow_down = np.fmin(down, self.k_position * (positions - self.soft_lower))
        slow_up = np.fmin(up, self.k_position * (self.soft_upper - positions))
        graded = self.k_position > 0.0
        known = np.isfinite(positions)
        down = np.where(known, np.where(graded, np.maximum(slow_down, 0.0), down), np.inf)
        up = np.where(known, np.where(graded, np.maximum(slow_up, 0.0), up), np.inf)
        return np.maximum(-self.velocity, -down), np.minimum(self.velocity, up)


class _States:
    """The same state of several joints; NaN for joints without that state interface."""

    def __init__(self, joints: Iterable[str], kind: str, resources: ResourceManager) -> None:
        names = [f"{joint}/{kind}" for joint in joints]
        existing = frozenset(
            name
            for component in resources.components.values()
            for name in component.hardware.state_interfaces
        )
        self._values = np.full(len(names), np.nan)
        self._known = np.array(
            [i for i, name in enumerate(names) if name in existing], dtype=np.intp
        )
        self._window = resources.loan_states([name for name in names if name in existing])

    def read(self) -> Values:
        """Return the current values, shape (n,); valid until the next call."""
        values = self._window.read()
        self._values[self._known] = np.where(np.isfinite(values), values, np.nan)
        return self._values


Rule = Callable[[_JointGroup, Values, Values, float], Band]
"""Returns the lowest and the highest command of a group; the lowest never exceeds the highest.

It takes the new commands, those of the last cycle, NaN for none, and the length of the cycle. The
new commands affect the bounds only if neither the last command nor the state is known.
"""


def _position_band(group: _JointGroup, commands: Values, previous: Values, period_s: float) -> Band:
    """Limit positions to the bounds, and their change to the speed limit."""
    speed = group.velocity
    if group.limits_acceleration:
        # In the next cycle the joint can be at most one acceleration step faster than now.
        present = np.nan_to_num(np.abs(group.velocities()))
        speed = np.minimum(speed, present + group.acceleration * period_s)
    origin = _origin(previous, group.positions(), commands)
    low, high = group.soft_velocities(origin)
    low = origin + np.maximum(low, -speed) * period_s
    high = origin + np.minimum(high, speed) * period_s
    # A joint does not step over a soft bound; a joint beyond one does not jump back.
    low = np.maximum(low, np.minimum(group.soft_lower, origin))
    high = np.minimum(high, np.maximum(group.soft_upper, origin))
    return _clipped(low, group.lower, group.upper), _clipped(high, group.lower, group.upper)


def _velocity_band(group: _JointGroup, commands: Values, previous: Values, period_s: float) -> Band:
    """Limit velocities to the speed limit, and so that no cycle ends beyond a bound.

    A joint beyond a bound may only go back.
    """
    positions = group.positions()
    low, high = group.soft_velocities(positions)
    # fmin and fmax ignore the NaN of an unknown position.
    low = np.fmax(low, np.minimum((group.lower - positions) / period_s, 0.0))
    high = np.fmin(high, np.maximum((group.upper - positions) / period_s, 0.0))
    if not group.limits_acceleration:
        return low, high
    origin = _origin(previous, group.velocities(), commands)
    step = group.acceleration * period_s
    # Clipped, not intersected: close to a bound the joint must brake, even beyond its
    # acceleration limit.
    return _clipped(origin - step, low, high), _clipped(origin + step, low, high)


def _effort_band(group: _JointGroup, commands: Values, previous: Values, period_s: float) -> Band:
    """Limit efforts; none further outwards at a position bound or above the speed limit."""
    positions, velocities = group.positions(), group.velocities()
    # A comparison with NaN is false, so an unknown state limits nothing.
    low_end = ((positions <= group.lower) & (velocities <= 0.0)) | (velocities < -group.velocity)
    high_end = ((positions >= group.upper) & (velocities >= 0.0)) | (velocities > group.velocity)
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


_RULES: Mapping[str, Rule] = {
    "position": _position_band,
    "velocity": _velocity_band,
    "effort": _effort_band,
    "acceleration": lambda group, *_: (-group.acceleration, group.acceleration),
    "jerk": lambda group, *_: (-group.jerk, group.jerk),
}
"""By the kind of the commands, those of `joint_limits.LIMITED`."""


def _origin(previous: Values, states: Values, commands: Values) -> Values:
    """Return the reference that changes are limited from.

    It is the last command; the state if there is none; the new command if neither is known. The
    last command comes first because the state lags behind it: relative to the state, the joint
    would never reach its speed limit.
    """
    unknown = np.isnan(previous)
    if not unknown.any():
        return previous
    origin = np.where(unknown, states, previous)
    # If not even the command is finite, any number will do.
    return np.where(np.isnan(origin), np.nan_to_num(commands), origin)


def _clipped(values: Values, low: Values, high: Values) -> Values:
    """Clip like np.clip, which takes five times as long for a handful of joints."""
    return np.minimum(np.maximum(values, low), high)


class CommandLimiter:
    """Clamps the manager's commands, once per cycle between controllers and hardware.

    Clamping keeps the order of two commands. NaN means no command and stays NaN. Loop thread
    only.
    """

    def __init__(self, limits: Mapping[str, JointLimits], resources: ResourceManager) -> None:
        """Find the commands that have limits; these are by joint."""
        names = [
            name
            for component in resources.components.values()
            for name in component.hardware.command_interfaces
            if name.rpartition("/")[0] in limits
        ]
        self._kinds = [
            _LimitedCommands(
                kind, [name for name in names if name.endswith(f"/{kind}")], limits, resources
            )
            for kind in LIMITED
            if any(name.endswith(f"/{kind}") for name in names)
        ]

    def claimed(self, commands: Collection[str]) -> None:
        """Note which commands are claimed now; newly claimed ones start from the states."""
        for kind in self._kinds:
            kind.claimed(commands)

    def forget(self, commands: Collection[str]) -> None:
        """Let these commands start from the states again."""
        for kind in self._kinds:
            kind.forget(commands)

    def restart(self) -> None:
        """Start from the states again."""
        for kind in self._kinds:
            kind.previous[:] = np.nan

    def save_state(self) -> list[Values]:
        """Return the commands of the last cycle, of each kind."""
        return [kind.previous for kind in self._kinds]

    def load_state(self, state: Sequence[Values]) -> None:
        """Set the commands of the last cycle."""
        for kind, previous in zip(self._kinds, state, strict=True):
            kind.previous[:] = previous

    def enforce(self, period_s: float) -> None:
        """Clamp every claimed command to what a cycle of this length allows."""
        if not period_s > 0.0:
            return
        # Missing bounds are infinite, so inf - inf and 0 * inf occur.
        with np.errstate(invalid="ignore", over="ignore"):
            for kind in self._kinds:
                kind.enforce(period_s)


class _LimitedCommands:
    """All commands of one kind, and their values in the last cycle.

    Attributes:
        previous: their values in the last cycle, NaN for none, shape (n,).
    """

    def __init__(
        self,
        kind: str,
        names: Sequence[str],
        limits: Mapping[str, JointLimits],
        resources: ResourceManager,
    ) -> None:
        joints = [name.rpartition("/")[0] for name in names]
        self._group = _JointGroup([limits[joint] for joint in joints], joints, resources)
        self._rule = _RULES[kind]
        self._names = names
        self._window = resources.loan_commands(names)
        self.previous = np.full(len(names), np.nan)
        self._held = np.zeros(len(names), dtype=bool)

    def claimed(self, commands: Collection[str]) -> None:
        """Forget the last values of commands that were unclaimed until now."""
        held = np.array([name in commands for name in self._names])
        self.previous[held & ~self._held] = np.nan
        self._held = held

    def forget(self, commands: Collection[str]) -> None:
        """Forget the last values of these commands."""
        self.previous[[name in commands for name in self._names]] = np.nan

    def enforce(self, period_s: float) -> None:
        """Clamp the claimed commands; leave the others as they are."""
        commands = self._window.read()
        low, high = self._rule(self._group, commands, self.previous, period_s)
        allowed = np.where(self._held, np.minimum(np.maximum(commands, low), high), commands)
        self._window.write(allowed)
        given = np.isfinite(allowed)
        self.previous[given] = allowed[given]
