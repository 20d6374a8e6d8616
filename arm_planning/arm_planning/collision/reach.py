"""How far a motion of the joints can move two bodies against each other."""

from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


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
    """

    part: NDArray[np.intp]
    part_of_body: NDArray[np.intp]
    pairs: Array


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
    for geom in range(model.ngeom):
        if part[geom]:
            found = radius[part[geom]]
            np.maximum(found, _radii(model, geom, lower, upper), out=found)
    carried = _carried(model, welds)
    apart = carried[:, None] ^ carried[None]
    pairs = np.where(carried[:, None], radius[:, None], radius[None]) * apart
    return Reach(part, part_of_body, pairs)


def _radii(model: mujoco.MjModel, geom: int, lower: Array, upper: Array) -> Array:
    """Return the largest distance of a geom's points from the axis of each joint, (nq,).

    From the geom towards the root: all places of the geom in the frame of a body lie in a ball. A
    joint turns the ball's middle on a circle, which lies with it in a larger ball around the middle
    of the circle; or slides it along a line.
    """
    found = np.zeros(model.nq)
    middle, radius = model.geom_pos[geom].copy(), float(model.geom_rbound[geom])
    body = int(model.geom_bodyid[geom])
    while body:
        if model.body_jntnum[body]:
            joint = int(model.body_jntadr[body])
            axis = model.jnt_axis[joint]
            if model.jnt_type[joint] == mujoco.mjtJoint.mjJNT_SLIDE:
                found[joint] = 1.0
                middle += axis * (lower[joint] + upper[joint]) / 2
                radius += (upper[joint] - lower[joint]) / 2
            else:
                arm = middle - model.jnt_pos[joint]
                along = axis * (arm @ axis)
                radius += float(np.linalg.norm(arm - along))
                middle = model.jnt_pos[joint] + along
                found[joint] = radius
        turned = np.zeros(3)
        mujoco.mju_rotVecQuat(turned, middle, model.body_quat[body])
        middle = model.body_pos[body] + turned
        body = int(model.body_parentid[body])
    return found


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
