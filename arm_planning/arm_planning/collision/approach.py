"""How soon bodies that are near can meet along a chord, from their speeds in one state of it.

`reach` bounds a body's motion in all states, as if each joint moved the farthest point the same
way. In one state the speeds are known: relative to another body, no point x of a body with the
middle c is faster than |v(c)| + |w| max |x - c|. Joints move at constant rates q' along a chord, so
no point's acceleration exceeds the sum, over all pairs of joints j and k, of |q'_j q'_k| times its
distance from the axis of the later joint of the two. A point thus moves by no more than
speed h + acceleration h^2 / 2 within a part h of the chord, in either direction.
"""

from collections.abc import Iterable
from math import sqrt

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_planning.collision.reach import Reach

Array = NDArray[np.float64]
Near = tuple[float, float, int, int, int]
"""A pair of geoms: the part of the chord that `reach` proves from here, the distance that may be
lost in m, the pair of parts, and both geoms."""


class Approach:
    """Bounds how soon geoms can meet; not thread-safe.

    Args:
        model: the model.
        data: its state; the velocities in it are overwritten.
        bounds: how far its parts can move.
    """

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData, bounds: Reach) -> None:
        self._model, self._data = model, data
        self._part = bounds.part.tolist()
        self._carries = bounds.carries.ravel().tolist()
        self._bounds = bounds.pairs.reshape(-1, model.nq)
        self._body = model.geom_bodyid.tolist()
        self._root = model.body_rootid[model.geom_bodyid].tolist()
        self._radius = model.geom_rbound.tolist()
        self._velocities, self._middles, self._points = data.cvel, data.geom_xpos, data.subtree_com
        self._change = np.zeros(model.nv)
        self._accelerations: list[float] = []

    def begin(self, change: Array) -> None:
        """Begin a chord that changes MuJoCo's coordinates by so much, (nq,)."""
        self._data.qvel[:] = change
        # Most chords are proved without them.
        self._change, self._accelerations = change, []

    def _bound_accelerations(self) -> list[float]:
        moved = np.abs(self._change)
        # Of two joints between the parts, the one with the larger number is carried by the other.
        between = np.where(self._bounds > 0.0, moved, 0.0)
        before = 2.0 * np.cumsum(between, axis=1) - between
        return (self._bounds * moved * before).sum(axis=1).tolist()

    def clear(self, near: Iterable[Near], limit: float) -> float:
        """Return for which part of the chord, in both directions, no pair of geoms meets.

        Args:
            near: the pairs that are near in the present state, the most urgent first.
            limit: for which part all other pairs do not meet.
        """
        model, data = self._model, self._data
        self._accelerations = self._accelerations or self._bound_accelerations()
        mujoco.mj_comPos(model, data)
        mujoco.mj_comVel(model, data)
        speeds: dict[tuple[int, int], float] = {}
        for part, distance, pair, first, second in near:
            if part >= limit:
                break
            limit = min(limit, max(part, self._alone(distance, pair, first, second, speeds)))
        return limit

    def _alone(
        self,
        distance: float,
        pair: int,
        first: int,
        second: int,
        speeds: dict[tuple[int, int], float],
    ) -> float:
        """Return for which part of the chord two geoms do not meet; 0 if only `reach` knows."""
        if not self._carries[pair]:
            return 0.0
        if self._part[first] > self._part[second]:
            first, second = second, first
        known = (self._part[first], second)
        if known not in speeds:
            speeds[known] = self._speed(first, second)
        speed = speeds[known]
        acceleration = self._accelerations[pair]
        return 2.0 * distance / (speed + sqrt(speed**2 + 2.0 * acceleration * distance))

    def _speed(self, first: int, second: int) -> float:
        """Return a bound of the speed of the second geom's points relative to the first's body."""
        # MuJoCo gives all velocities of a tree at one point. On so few numbers NumPy is slower.
        velocities = self._velocities
        wx, wy, wz, vx, vy, vz = velocities[self._body[second]].tolist()
        if self._part[first]:
            ax, ay, az, bx, by, bz = velocities[self._body[first]].tolist()
            wx, wy, wz, vx, vy, vz = wx - ax, wy - ay, wz - az, vx - bx, vy - by, vz - bz
        x, y, z = (self._middles[second] - self._points[self._root[second]]).tolist()
        ux, uy, uz = vx + wy * z - wz * y, vy + wz * x - wx * z, vz + wx * y - wy * x
        return sqrt(ux * ux + uy * uy + uz * uz) + self._radius[second] * sqrt(
            wx * wx + wy * wy + wz * wz
        )
