"""Limits and states of several joints, as arrays."""

from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

from arm_control.joint_limits import NO_SOFT_LIMITS, JointLimits
from arm_control.resource_manager import ResourceManager

Values = NDArray[np.float64]
"""One number per joint, shape (n,)."""

Band = tuple[Values, Values]
"""The lowest and the highest, each of shape (n,)."""


class JointGroup:
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
        """Return where the joints are; NaN where nobody knows."""
        return self._positions.read()

    def velocities(self) -> Values:
        """Return how fast they move; NaN where nobody knows."""
        return self._velocities.read()

    def soft_velocities(self, positions: Values) -> Band:
        """Return the lowest and the highest velocity from a position on.

        Towards a soft bound it falls with the distance; beyond it, only the way back is open.
        A joint of which nobody knows where it is has no soft bound.
        """
        if not self._has_soft_limits:
            return -self.velocity, self.velocity
        down = np.where(positions > self.soft_lower, np.inf, 0.0)
        up = np.where(positions < self.soft_upper, np.inf, 0.0)
        # fmin passes over the NaN of 0 times infinity, where a joint has no soft bound.
        slow_down = np.fmin(down, self.k_position * (positions - self.soft_lower))
        slow_up = np.fmin(up, self.k_position * (self.soft_upper - positions))
        graded = self.k_position > 0.0
        known = np.isfinite(positions)
        down = np.where(known, np.where(graded, np.maximum(slow_down, 0.0), down), np.inf)
        up = np.where(known, np.where(graded, np.maximum(slow_up, 0.0), up), np.inf)
        return np.maximum(-self.velocity, -down), np.minimum(self.velocity, up)


class _States:
    """One state of each of several joints; NaN where a joint does not show it."""

    def __init__(self, joints: Iterable[str], kind: str, resources: ResourceManager) -> None:
        names = [f"{joint}/{kind}" for joint in joints]
        there = frozenset(
            name
            for component in resources.components.values()
            for name in component.hardware.state_interfaces
        )
        self._values = np.full(len(names), np.nan)
        self._known = np.array([i for i, name in enumerate(names) if name in there], dtype=np.intp)
        self._window = resources.loan_states([name for name in names if name in there])

    def read(self) -> Values:
        """Return the present values, shape (n,); valid until the next call."""
        values = self._window.read()
        self._values[self._known] = np.where(np.isfinite(values), values, np.nan)
        return self._values
