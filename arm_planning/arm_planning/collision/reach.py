"""How far a motion of the joints can move two bodies against each other, and what none reaches.

A joint that turns keeps the distance between a point on its axis and whatever it carries. So no
point is farther from an axis than the shortest way to it that leads over one point on each axis
between the two. Any points do; with some to choose from, an arm reaches nearly all of the length.
"""

from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
BEYOND_M = 1e-3
"""What is farther away than this from all places of all links is out of reach."""
MANY = 16
"""Of fewer fixed shapes it costs more to find those out of reach than to look at them."""
BETWEEN = 12
"""Points of an axis over which ways may lead, besides those next to other axes."""
PARALLEL = 0.01
"""Axes count as parallel below this squared sine of their angle: they are next to each other far
away."""


@dataclass(frozen=True, slots=True, eq=False)
class Reach:
    """Bounds of the relative motion of parts; a part is what moves as one, 0 is all that is fixed.

    Attributes:
        part: the part of each geom, (ngeom,).
        part_of_body: the part of each body, (nbody,).
        pairs: for two parts the most that a point moves against the other part for each radian or
            metre of each coordinate, (parts, parts, coordinates): 0 for joints that are not on the
            way between them, 1 for sliding joints, and for turning joints the largest distance from
            the axis that a point of the part beyond can have.
        carries: whether one of two parts carries the other, so that all joints between them move
            the one with the larger number against the other, (parts, parts).
    """

    part: NDArray[np.intp]
    part_of_body: NDArray[np.intp]
    pairs: Array
    carries: Mask


def reach(model: mujoco.MjModel, data: mujoco.MjData, lower: Array, upper: Array) -> Reach:
    """Return the bounds of a model.

    Args:
        model: the model; each body has at most one joint, a hinge or a slide.
        data: its state, which is changed.
        lower: least positions of the coordinates, (nq,); only those of sliding joints matter.
        upper: largest positions.
    """
    welds, part_of_body = np.unique(model.body_weldid, return_inverse=True)
    part = part_of_body[model.geom_bodyid]
    moving = np.flatnonzero(part)
    ways = _Ways(model, data, moving, lower, upper)
    radius = np.zeros((len(welds), model.nq))
    np.maximum.at(radius, part[moving], ways.from_axes())
    carried = ways.carried[model.body_jntadr[welds]]
    apart = carried[:, None] ^ carried[None]
    pairs = np.where(carried[:, None], radius[:, None], radius[None]) * apart
    beyond = np.asarray((carried[:, None] | ~carried[None]).all(axis=2))
    return Reach(part, part_of_body, pairs, beyond | beyond.T)


def never_touching(model: mujoco.MjModel, data: mujoco.MjData) -> Mask:
    """Return which bodies MuJoCo need not look at, because they touch nothing in any state.

    Those are fixed bodies out of reach, and bodies that reach no fixed one if their bits let them
    touch no other. Nothing is out of reach if a joint slides, because it may leave its limits.

    Args:
        model: the model; pairs of geoms that have names of their own do not count.
        data: its state, which is changed.

    Returns:
        A mask, (nbody,).
    """
    body, contype, conaffinity = model.geom_bodyid, model.geom_contype, model.geom_conaffinity
    moves = model.body_weldid[body] > 0
    fixed, moving = np.flatnonzero(~moves), np.flatnonzero(moves)
    touch = (contype[fixed, None] & conaffinity[moving]) != 0
    touch |= (conaffinity[fixed, None] & contype[moving]) != 0
    slides = (model.jnt_type == int(mujoco.mjtJoint.mjJNT_SLIDE)).any()
    if not slides and np.count_nonzero(touch.any(axis=1)) >= MANY:
        none = np.zeros(model.nq)
        middle, radius = _Ways(model, data, moving, none, none).balls()
        apart = np.linalg.norm(data.geom_xpos[fixed][:, None] - middle, axis=2)
        # A plane has no radius: it is endless.
        own = np.where(model.geom_rbound[fixed] > 0.0, model.geom_rbound[fixed], np.inf)
        touch &= apart < radius + own[:, None] + BEYOND_M
    found = np.ones(model.nbody, bool)
    found[body[fixed[touch.any(axis=1)]]] = False
    among = np.bitwise_or.reduce(contype[moving]) & np.bitwise_or.reduce(conaffinity[moving])
    found[body[moving if among else moving[touch.any(axis=0)]]] = False
    return found


class _Ways:
    """The shortest ways to geoms over some points of the axis of each joint that moves them.

    A joint that slides has the points of the one above it, and is as much longer as it spreads.

    Args:
        model: the model.
        data: its state, which is changed.
        geoms: geoms that joints move.
        lower: least positions of the coordinates, (nq,).
        upper: largest positions.

    Attributes:
        carried: which joints move what a joint moves, (nq + 1, nq); the last row is of the world.
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        data: mujoco.MjData,
        geoms: NDArray[np.intp],
        lower: Array,
        upper: Array,
    ) -> None:
        self._slides = model.jnt_type == int(mujoco.mjtJoint.mjJNT_SLIDE)
        self._spread = np.where(self._slides, upper - lower, 0.0) / 2.0
        data.qpos[:] = np.where(self._slides, lower + upper, 0.0) / 2.0
        mujoco.mj_kinematics(model, data)
        joint_of = model.body_jntadr[model.body_weldid]
        self._above = joint_of[model.body_parentid[model.jnt_bodyid]].tolist()
        self._last = joint_of[model.geom_bodyid[geoms]]
        self.carried = np.zeros((model.nq + 1, model.nq), bool)
        for joint, above in enumerate(self._above):
            self.carried[joint] = self.carried[above]
            self.carried[joint, joint] = True
        self._middles, self._radii = data.geom_xpos[geoms], model.geom_rbound[geoms]
        self._anchors, self._axes = data.xanchor, data.xaxis
        self._points = self._points_on_axes()
        for joint in np.flatnonzero(self._slides):
            self._points[joint] = self._points[self._above[joint]]

    def from_axes(self) -> Array:
        """Return the largest distance of geoms' points from the axis of each joint, (geoms, nq).

        It is 1 for joints that slide, and 0 for those that do not move a geom.
        """
        joints, geoms = np.arange(len(self._above)), np.arange(len(self._last))
        lengths = self._endless()
        lengths[joints, joints] = 0.0
        found = self._to_geoms(lengths).T
        # From the axis of the last joint it is known, wherever the points are.
        arms = self._middles - self._anchors[self._last]
        across = np.linalg.norm(np.cross(arms, self._axes[self._last]), axis=1)
        found[geoms, self._last] = across + self._radii
        return np.where(self.carried[self._last], np.where(self._slides, 1.0, found), 0.0)

    def balls(self) -> tuple[Array, Array]:
        """Return a ball for each geom with all of its places: middles, (geoms, 3), and radii.

        The middle is on the axis of the first joint, next to another.
        """
        lengths, joints = self._endless(), np.arange(len(self._above))
        for joint in np.flatnonzero(np.array(self._above) < 0):
            lengths[joints, joint, joints] = 0.0
        found = self._to_geoms(lengths)
        first = self.carried[self._last].argmax(axis=1)
        return self._points[first, found.argmin(axis=0)], found.min(axis=0)

    def _endless(self) -> Array:
        return np.full((len(self._above), *self._points.shape[:2]), np.inf)

    def _points_on_axes(self) -> Array:
        """Return points on each axis, (nq, k, 3): the one next to each other axis, then others."""
        axes, places = self._axes, (self._anchors * self._axes).sum(axis=1)
        cosines, steps = axes @ axes.T, self._anchors @ axes.T
        # Along the axis of a row and of a column, from the row's anchor to the column's.
        ahead, back = steps.T - places[:, None], places - steps
        apart = 1.0 - cosines**2
        next_to = np.where(
            apart > PARALLEL, (ahead - cosines * back) / np.maximum(apart, PARALLEL), ahead
        )
        next_to = np.where(self.carried[:-1] | self.carried[:-1].T, next_to, 0.0)
        heights = np.where(self.carried[self._last], self._middles @ axes.T - places, 0.0)
        within = np.vstack([next_to.T, heights])
        others = np.linspace(within.min(axis=0), within.max(axis=0), BETWEEN, axis=1)
        heights = np.hstack([next_to, others])
        return self._anchors[:, None] + heights[:, :, None] * axes[:, None]

    def _to_geoms(self, lengths: Array) -> Array:
        """Return the lengths of the shortest ways to all points of geoms, (ways, geoms).

        Args:
            lengths: 0 at the points where a way may begin, elsewhere infinite, (ways, nq, k).
        """
        points = self._points
        for joint, above in enumerate(self._above):
            if above >= 0 and self._slides[joint]:
                lengths[:, joint] = lengths[:, above] + self._spread[joint]
            elif above >= 0:
                steps = np.linalg.norm(points[above][:, None] - points[joint], axis=2)
                there = (lengths[:, above, :, None] + steps).min(axis=1)
                np.minimum(lengths[:, joint], there, out=lengths[:, joint])
        last = np.linalg.norm(points[self._last] - self._middles[:, None], axis=2)
        return (lengths[:, self._last] + last).min(axis=2) + self._radii
