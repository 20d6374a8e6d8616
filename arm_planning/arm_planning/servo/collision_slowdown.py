"""Slows a jog down before what it approaches; what moves apart is never slowed down."""

import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from arm_planning.collision.proximity import Proximity
from arm_planning.servo.joint_bounds import JointBounds
from arm_planning.servo.settings import ServoSettings
from arm_planning.servo.status import JogStatus, Slowdown, StatusCode

Array = NDArray[np.float64]

STEEPNESS = math.log(1000.0)
"""moveit_servo's: in contact a thousandth of the speed would be left."""
STOP_M = 0.0005
"""Distance at which nothing comes nearer."""
NOISE_M = 1e-7
"""Changes of a distance below it are errors of the distance."""
MOST_AHEAD_M = 0.06
"""More than jogs need to brake; a larger one takes longer to compute."""


class CollisionSlowdown:
    """Compares distances now with those a moment later.

    Not thread-safe.

    Args:
        proximity: distances between the robot's bodies and to the scene's.
        bounds: how soon the joints stop.
        reach_m: how far the farthest part of the robot is from a joint.
        settings: the distances from which it slows down.
    """

    def __init__(
        self, proximity: Proximity, bounds: JointBounds, reach_m: float, settings: ServoSettings
    ) -> None:
        self._proximity, self._settings = proximity, settings
        self._bounds, self._reach_m = bounds, reach_m

    def of(self, q: Array, speeds: Array, period_s: float) -> Slowdown:
        """Return by what to slow down at wanted speeds, (n,), from a state, (n,), for a period."""
        stop_s = self._bounds.stop_s(speeds)
        braking_m = float(np.abs(speeds).sum()) * self._reach_m * stop_s / 2.0
        thresholds = (self._settings.self_proximity_m, self._settings.scene_proximity_m)
        within_m = max(thresholds) + min(braking_m, MOST_AHEAD_M)
        least, nearest = 1.0, None
        for pair, distance_m, closing_m in self._closing(q, speeds, period_s, within_m):
            factor = self._factor(pair, distance_m, closing_m / period_s, stop_s)
            if factor < least:
                least, nearest = factor, (pair, distance_m)
        if nearest is None:
            return Slowdown()
        return Slowdown(least, self._status(least, *nearest))

    def forbids(self, q: Array, speeds: Array, period_s: float) -> Slowdown:
        """Return a halt if a motion of one period would bring something nearer than it may be."""
        within_m = STOP_M + self._step_m(speeds, period_s)
        for pair, distance_m, closing_m in self._closing(q, speeds, period_s, within_m):
            if distance_m - closing_m < STOP_M:
                return Slowdown(0.0, self._status(0.0, pair, distance_m))
        return Slowdown()

    def _closing(
        self, q: Array, speeds: Array, period_s: float, within_m: float
    ) -> Iterator[tuple[int, float, float]]:
        """Yield the pairs that come nearer: the distance now, and by how much it shrinks."""
        now = self._proximity.near(q, within_m)
        later = self._proximity.near(q + period_s * speeds, within_m) if now else {}
        for pair, distance_m in now.items():
            closing_m = distance_m - later.get(pair, math.inf)
            if closing_m > NOISE_M:
                yield pair, distance_m, closing_m

    def _step_m(self, speeds: Array, period_s: float) -> float:
        return 2.0 * float(np.abs(speeds).sum()) * self._reach_m * period_s

    def _factor(self, pair: int, distance_m: float, closing_mps: float, stop_s: float) -> float:
        if distance_m <= STOP_M:
            return 0.0
        settings = self._settings
        threshold_m = (
            settings.scene_proximity_m
            if self._proximity.is_with_world(pair)
            else settings.self_proximity_m
        )
        by_distance = math.exp(min(STEEPNESS / threshold_m * (distance_m - threshold_m), 0.0))
        # Speed and time to stop shrink together, so the way shrinks with the square.
        braking_m = closing_mps * stop_s / 2.0
        return min(1.0, by_distance, math.sqrt((distance_m - STOP_M) / max(braking_m, 1e-12)))

    def _status(self, factor: float, pair: int, distance_m: float) -> JogStatus:
        first, second = self._proximity.names(pair)
        apart = f"{1e3 * distance_m:.1f} mm apart" if distance_m > 0.0 else "in contact"
        where = f"{first} with {second}, {apart}"
        if factor > 0.0:
            return JogStatus(StatusCode.DECELERATE_FOR_COLLISION, f"collision ahead: {where}")
        return JogStatus(StatusCode.HALT_FOR_COLLISION, f"stopped before a collision: {where}")
