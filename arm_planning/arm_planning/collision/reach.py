"""How far a motion of the joints can move two bodies against each other, and what none reaches."""

from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
BEYOND_M = 1e-3
"""What is farther away than this from all places of all links is out of reach."""
MANY = 16
"""Of fewer fixed bodies it costs more to find those out of reach than to look at them."""


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
    carries: NDArray[np.bool_]


def reach(model: mujoco.MjModel, lower: Array, upper: Array) -> Reach:
    """Return the bounds of a model.

    Args:
        model: the model; each body has at most one joint, a hinge or a slide.
        lower: least positions of the coordinates, (nq,); only those of sliding joints matter.
        upper: largest positions.
    """
    welds, part_of_body = np.unique(model.body_weldid, return_inverse=True)
    part = part_of_body[model.geom_bodyid]
    radius = np.zeros((len(welds), model.nq))
    moving = np.flatnonzero(part)
    radii, _, _ = _radii(model, moving, lower, upper)
    np.maximum.at(radius, part[moving], radii)
    carried = _carried(model, welds)
    apart = carried[:, None] ^ carried[None]
    pairs = np.where(carried[:, None], radius[:, None], radius[None]) * apart
    beyond = np.asarray((carried[:, None] | ~carried[None]).all(axis=2))
    return Reach(part, part_of_body, pairs, beyond | beyond.T)


def out_of_reach(model: mujoco.MjModel) -> NDArray[np.bool_]:
    """Return which fixed bodies nothing that moves can touch in any state, (nbody,).

    None is, if a joint slides, because it may leave its limits, or if they are few.
    """
    body = model.geom_bodyid
    is_fixed = (model.body_weldid == 0) & (model.body_parentid == 0)
    is_fixed[0] = False
    slides = (model.jnt_type == int(mujoco.mjtJoint.mjJNT_SLIDE)).any()
    if slides or np.count_nonzero(is_fixed) < MANY:
        return np.zeros(model.nbody, bool)
    moving = np.flatnonzero(model.body_weldid[body])
    fixed = np.flatnonzero(is_fixed[body])
    none = np.zeros(model.nq)
    _, middle, radius = _radii(model, moving, none, none)
    apart = np.linalg.norm(_fixed_places(model, fixed)[:, None] - middle, axis=2)
    # A plane has no radius: it is endless.
    own = np.where(model.geom_rbound[fixed] > 0.0, model.geom_rbound[fixed], np.inf)
    near = fixed[(apart < radius + own[:, None] + BEYOND_M).any(axis=1)]
    is_fixed[body[near]] = False
    return is_fixed


def _fixed_places(model: mujoco.MjModel, geoms: NDArray[np.intp]) -> Array:
    """Return the middles of geoms on bodies that are fixed in the world, (geoms, 3)."""
    body, place = model.geom_bodyid[geoms], model.geom_pos[geoms]
    w, axis = model.body_quat[body, :1], model.body_quat[body, 1:]
    turn = 2.0 * np.cross(axis, place)
    return model.body_pos[body] + place + w * turn + np.cross(axis, turn)


def _radii(
    model: mujoco.MjModel, geoms: NDArray[np.intp], lower: Array, upper: Array
) -> tuple[Array, Array, Array]:
    """Return the largest distance of geoms' points from the axis of each joint, (geoms, nq).

    And a ball for each geom with all of its places in the world: middles, (geoms, 3), and radii.

    From each geom towards the root: all places of the geom in the frame of a body lie in a ball. A
    joint turns the ball's middle on a circle, which lies with it in a larger ball around the middle
    of the circle; or slides it along a line.
    """
    found = np.zeros((len(geoms), model.nq))
    middle, radius = model.geom_pos[geoms], model.geom_rbound[geoms]
    frame = model.geom_bodyid[geoms].copy()
    rotation = np.zeros(9)
    # A body comes after its parent.
    for body in range(int(frame.max(initial=0)), 0, -1):
        here = np.flatnonzero(frame == body)
        if not len(here):
            continue
        if model.body_jntnum[body]:
            joint = int(model.body_jntadr[body])
            axis, anchor = model.jnt_axis[joint], model.jnt_pos[joint]
            if model.jnt_type[joint] == int(mujoco.mjtJoint.mjJNT_SLIDE):
                found[here, joint] = 1.0
                middle[here] += axis * (lower[joint] + upper[joint]) / 2
                radius[here] += (upper[joint] - lower[joint]) / 2
            else:
                arm = middle[here] - anchor
                along = (arm @ axis)[:, None] * axis
                radius[here] += np.linalg.norm(arm - along, axis=1)
                middle[here] = anchor + along
                found[here, joint] = radius[here]
        mujoco.mju_quat2Mat(rotation, model.body_quat[body])
        middle[here] = middle[here] @ rotation.reshape(3, 3).T + model.body_pos[body]
        frame[here] = model.body_parentid[body]
    return found, middle, radius


def _carried(model: mujoco.MjModel, welds: NDArray[np.int32]) -> NDArray[np.bool_]:
    """Return which coordinates move each part against the world, (parts, nq)."""
    carried = np.zeros((len(welds), model.nq), bool)
    for row, weld in enumerate(welds):
        body = int(weld)
        while body:
            if model.body_jntnum[body]:
                carried[row, model.body_jntadr[body]] = True
            body = int(model.body_parentid[body])
    return carried
