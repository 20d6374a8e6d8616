"""The joints' speeds for a velocity of the tip, and how near a singularity is.

The condition number compares lengths with angles, so lengths are measured in a third of the chain's
reach: in metres no state of an arm of 0.3 m is below moveit_servo's threshold of 17. (J. Angeles,
"Fundamentals of Robotic Mechanical Systems", on the characteristic length.)
"""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from arm_planning.constraints.evaluation import rotation_vector
from arm_planning.kinematics.chain import Chain
from arm_planning.servo.joint_bounds import JointBounds
from arm_planning.servo.settings import ServoSettings
from arm_planning.servo.status import JogStatus, Slowdown, StatusCode

Array = NDArray[np.float64]

TINY = 1e-18
LENGTH_OF_REACH = 1.0 / 3.0
TURN_WEIGHT = 0.1
"""Of the orientation beside the position, for arms that cannot follow both."""
FULL = 6
"""Directions in which a tip can move and turn."""
LOOK_AHEAD = 0.01
"""How far ahead it is looked whether the singularity comes nearer, rad or m."""
PARTS = (1.0, 0.7, 0.5, 0.35, 0.25, 0.15, 0.1, 0.05)
"""Factors that are tried until the joints stop in time."""
PART_OF_NOTICE = 0.05
"""Share of a direction below which it counts as having none."""
MORE = 1.0 + 1e-6
LEAST_OUT = 0.5
"""Factor below which the way out of a singularity is never slowed down."""
LOST = 0.2
"""Share of the wanted velocity below which its direction counts as lost."""
NULL_STEP = 0.05
"""How far a joint motion that is lost to first order is tried, rad or m."""
NULL_SPEED = 0.5
"""Its speed for the largest command, rad/s or m/s."""


class TipVelocity:
    """Solves for the joints' speeds. For one thread at a time.

    Arms with fewer than six joints follow the position first, and the orientation as far as they
    can. The settings have the thresholds of the condition number.
    """

    def __init__(self, chain: Chain, bounds: JointBounds, settings: ServoSettings) -> None:
        self._chain, self._bounds = chain, bounds
        self._full_mps = settings.linear_scale
        self._lower = settings.lower_singularity_threshold
        self._hard = settings.hard_stop_singularity_threshold
        self._leaving = settings.leaving_singularity_threshold_multiplier
        self._length_m = (chain.reach_m or 1.0) * LENGTH_OF_REACH
        self._rank = min(FULL, int(np.count_nonzero(chain.moving)))
        turn = 1.0 if self._rank == FULL else TURN_WEIGHT
        self._weights = np.repeat([1.0 / self._length_m, turn], 3)

    def condition(self, q: Array, twist: Array | None = None) -> float:
        """Return the condition number of a state, (n,), or that of one direction.

        That of a direction is how much faster joints move for it than for the easiest one: at most
        that of the state, with which it agrees for the direction that is lost next. So a wrist that
        is stretched is no reason to slow down what it has no part in.

        Args:
            q: the state, (n,).
            twist: velocity and angular velocity of the tip, (6,); None for all directions.

        Returns:
            1 to infinity.
        """
        jacobian = self._jacobian(q)
        jacobian[:3] /= self._length_m
        u, sizes, _ = np.linalg.svd(jacobian, full_matrices=False)
        # Fewer joints than directions have fewer singular values.
        ratios = sizes[: self._rank] / max(float(sizes[0]), TINY)
        if twist is None:
            return 1.0 / max(float(ratios[-1]), TINY)
        parts = np.abs(self._scaled(twist) @ u[:, : self._rank])
        parts = np.where(parts < PART_OF_NOTICE, 0.0, parts)
        return max(1.0, float(np.linalg.norm(parts / np.maximum(ratios, TINY))))

    def solve(self, q: Array, twist: Array) -> tuple[Array, Slowdown]:
        """Return the speeds of the joints, (n,), not slowed down, and by what to slow them down.

        Args:
            q: the state, (n,).
            twist: velocity of the tip and angular velocity, in the planning frame, m/s and rad/s,
                (6,).
        """
        wanted = self._weights * twist
        if not wanted.any():
            return np.zeros_like(q), Slowdown()
        weighted = self._weights[:, None] * self._jacobian(q)
        u, sizes, v = np.linalg.svd(weighted, full_matrices=False)
        excess = self._excess(sizes[0] / np.maximum(sizes, TINY))
        damping = sizes[0] / self._hard * np.clip(excess, 0.0, 1.0)
        inverse = sizes / np.maximum(sizes**2 + damping**2, TINY)
        speeds = v.T @ (inverse * (u.T @ wanted))
        reached = float(np.linalg.norm(weighted @ speeds) / np.linalg.norm(wanted))
        if self._rank == FULL and reached < LOST:
            return self._lost(q, wanted, v[sizes < sizes[0] / self._hard])
        speeds = self._bounds.within_velocities(speeds)
        return speeds, self._slowdown(q, speeds, twist)

    def _scaled(self, twist: Array) -> Array:
        """Return the direction of a twist whose lengths are measured in the arm's own."""
        scaled = twist / np.repeat([self._length_m, 1.0], 3)
        return scaled / max(float(np.linalg.norm(scaled)), TINY)

    def _excess(self, condition: float | Array) -> Any:
        """Return where condition numbers are between the thresholds: 0 at the lower one, 1 at 1."""
        return (condition - self._lower) / max(self._hard - self._lower, TINY)

    def _slowdown(self, q: Array, speeds: Array, twist: Array) -> Slowdown:
        condition = self.condition(q, twist)
        direction = speeds / max(float(np.linalg.norm(speeds)), TINY)
        if self.condition(q + LOOK_AHEAD * direction, twist) > condition * MORE:
            return self._approach(q, speeds, twist, condition)
        excess = self._excess(condition)
        if excess <= 0.0:
            return Slowdown()
        code = StatusCode.DECELERATE_FOR_LEAVING_SINGULARITY
        return Slowdown(max(1.0 - excess / self._leaving, LEAST_OUT), _status(code, condition))

    def _approach(self, q: Array, speeds: Array, twist: Array, condition: float) -> Slowdown:
        """Return a factor with which the joints stop before the threshold."""
        stop = speeds * self._bounds.stop_s(speeds) / 2.0
        by_condition = min(1.0 - self._excess(condition), 1.0)
        for part in PARTS if by_condition > 0.0 else ():
            factor = part * by_condition
            ahead = (q + share * factor**2 * stop for share in (0.5, 1.0))
            if all(self.condition(state, twist) < self._hard for state in ahead):
                code = StatusCode.DECELERATE_FOR_APPROACHING_SINGULARITY
                return Slowdown(factor, _status(code, condition))
        return Slowdown(0.0, _status(StatusCode.HALT_FOR_SINGULARITY, condition))

    def _lost(self, q: Array, wanted: Array, directions: Array) -> tuple[Array, Slowdown]:
        """Return the way out along a direction that is lost to first order, if there is one.

        A stretched arm cannot pull its tip back by any speed of its joints; yet a bent elbow is
        nearer, on whichever side.
        """
        best, most = np.zeros_like(q), 1e-3 * NULL_STEP**2
        length = float(np.linalg.norm(wanted))
        start = self._chain.pose(q)
        for direction in (*directions, *-directions):
            end = self._chain.pose(q + NULL_STEP * direction)
            moved = self._weights * pose_difference(start, end)
            gain = float(moved @ wanted) / length
            if gain > most:
                best, most = direction, gain
        if not best.any():
            status = JogStatus(
                StatusCode.HALT_FOR_SINGULARITY, "singularity: the tip cannot move that way"
            )
            return best, Slowdown(0.0, status)
        speeds = NULL_SPEED * min(length * self._length_m / self._full_mps, 1.0) * best
        status = JogStatus(StatusCode.DECELERATE_FOR_LEAVING_SINGULARITY, "leaving a singularity")
        # The speed is already that of the way out.
        return speeds, Slowdown(math.nextafter(1.0, 0.0), status)

    def _jacobian(self, q: Array) -> Array:
        self._chain.place(q)
        return self._chain.jacobian().copy()


def pose_difference(start: Array, end: Array) -> Array:
    """Return the way from one pose to another, both (4, 4): m, then a rotation vector, (6,)."""
    turn = rotation_vector(end[:3, :3] @ start[:3, :3].T)
    return np.concatenate([end[:3, 3] - start[:3, 3], turn])


def _status(code: StatusCode, condition: float) -> JogStatus:
    verb = {
        StatusCode.HALT_FOR_SINGULARITY: "stopped before",
        StatusCode.DECELERATE_FOR_APPROACHING_SINGULARITY: "approaching",
        StatusCode.DECELERATE_FOR_LEAVING_SINGULARITY: "leaving",
    }[code]
    number = f"condition number {condition:.0f}" if condition < 1e4 else "no way out in one line"
    return JogStatus(code, f"{verb} a singularity: {number}")
