"""The limits of the joints: velocities, positions with their margins, accelerations."""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from arm_planning.errors import InvalidRequestError
from arm_planning.robot.model import JointGroup
from arm_planning.servo.status import JogStatus, Slowdown, StatusCode

Array = NDArray[np.float64]

URGENT = 4.0
"""How much harder than by their limits joints brake before a collision."""
UNLIMITED = 1e4
"""Acceleration of a joint that has no limit, rad/s^2 or m/s^2."""
AT_LIMIT = 1e-4
"""How near a margin counts as at it, rad or m."""


class JointBounds:
    """What a group's joints may do.

    Args:
        group: the joints and their limits.
        margins: distances to keep from the position limits, one for all or one for each.
        velocity_factor: of the velocity limits.

    Attributes:
        acceleration: rad/s^2 or m/s^2, (n,).

    Raises:
        PlanningError: the number of margins fits neither.
    """

    def __init__(
        self, group: JointGroup, margins: Sequence[float], velocity_factor: float = 1.0
    ) -> None:
        if len(margins) not in (1, len(group.joints)):
            raise InvalidRequestError(
                f"joint_limit_margins has {len(margins)} numbers; it has one for all joints, or "
                f"one for each of the {len(group.joints)}"
            )
        self._joints = group.joints
        self._velocity = velocity_factor * np.array([each.velocity for each in group.limits])
        accelerations = [min(each.acceleration, UNLIMITED) for each in group.limits]
        self.acceleration: Array = np.array(accelerations)
        self._lower, self._upper = group.lower, group.upper
        margin = np.broadcast_to(np.asarray(margins, dtype=float), len(group.joints))
        # A range that is too narrow for its margins has none.
        margin = np.where(self._upper - self._lower > 2.0 * margin, margin, 0.0)
        self._low, self._high = self._lower + margin, self._upper - margin

    def within_velocities(self, speeds: Array) -> Array:
        """Return speeds in the same direction that no joint's velocity limit forbids, (n,)."""
        return speeds / max(1.0, float((np.abs(speeds) / self._velocity).max()))

    def stop_s(self, speeds: Array) -> float:
        """Return how long the joints take to stop together."""
        return float((np.abs(speeds) / self.acceleration).max())

    def within_positions(
        self, q: Array, speeds: Array, period_s: float, *, halts_all: bool
    ) -> tuple[Array, Slowdown]:
        """Return speeds from which each joint still stops before its margin, (n,), and why.

        A joint within its margin may move away from the limit. The wanted speeds, (n,), last at
        least for the period. With `halts_all`, all joints slow down with the one that must; else
        only that one.
        """
        room = np.where(speeds > 0.0, self._high - q, q - self._low)
        allowed = _stoppable(np.maximum(room, 0.0), self.acceleration, period_s)
        wanted = np.abs(speeds)
        factors = np.where(wanted > allowed, allowed / np.maximum(wanted, 1e-12), 1.0)
        joint = int(np.argmin(factors))
        if factors[joint] >= 1.0:
            return speeds, Slowdown()
        name, limit = self._joints[joint], "upper" if speeds[joint] > 0.0 else "lower"
        where = "at" if room[joint] <= AT_LIMIT else "near"
        status = JogStatus(
            StatusCode.JOINT_BOUND, f"joint {name} is {where} the margin of its {limit} limit"
        )
        slower = speeds * (factors[joint] if halts_all else factors)
        return slower, Slowdown(float(factors[joint]), status)

    def ramped(
        self, before: Array, wanted: Array, period_s: float, *, is_urgent: bool = False
    ) -> Array:
        """Return the speeds after a period, (n,): as near to the wanted ones as accelerations let.

        If it is urgent, the joints may brake harder than they accelerate.
        """
        change = wanted - before
        most = self.acceleration * period_s * (URGENT if is_urgent else 1.0)
        return before + change / max(1.0, float((np.abs(change) / most).max()))

    def kept_inside(self, q: Array, speeds: Array, period_s: float) -> Array:
        """Return speeds that lead no joint over its limit in a period, (n,).

        A joint that is beyond a limit already may stay or come back.
        """
        low = np.minimum((self._lower - q) / period_s, 0.0)
        high = np.maximum((self._upper - q) / period_s, 0.0)
        return np.clip(speeds, low, high)


def _stoppable(room: Array, acceleration: Array, period_s: float) -> Array:
    """Return the largest speeds from which joints stop within their room after a period, (n,)."""
    first = acceleration * period_s
    speeds = np.sqrt(first**2 + 2.0 * acceleration * np.where(np.isfinite(room), room, 0.0)) - first
    return np.where(np.isfinite(room), speeds, math.inf)
