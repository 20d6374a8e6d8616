"""The first view of the window: the robots and nearby objects fill it."""

import math

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_description.view_fitting import Body, Points, View, body_of, fit_view

ASPECT = 1.3
"""Approximate aspect ratio of the window; a wider window shows more at the sides."""
GROUND_M, GROUND_THICKNESS_M = 5.0, 0.1
"""A geom at least this long and wide, and thinner than this, counts as ground."""
DRAWN_GROUPS = (0, 1, 2)
MAX_HITS = 20
"""Limit on a line's hits on robots, which do not block the view; beyond it the line is blocked."""
STEP = 1e-4
OPAQUE = 0.9


def first_view(model: mujoco.MjModel, data: mujoco.MjData) -> View | None:
    """Return the first view of a model in a state; None if there is nothing but ground.

    Everything that actuators move counts as a robot.
    """
    robots, things = [], []
    of_robots = _robot_geoms(model)
    for geom in range(model.ngeom):
        body = _body(model, data, geom)
        if body is not None:
            (robots if of_robots[geom] else things).append(body)

    def blocked(starts: Points, ends: Points) -> NDArray[np.bool_]:
        lines = zip(starts, ends, strict=True)
        return np.array([_is_blocked(model, data, of_robots, *line) for line in lines])

    return fit_view(robots, things, blocked, math.radians(model.vis.global_.fovy), ASPECT)


def _robot_geoms(model: mujoco.MjModel) -> NDArray[np.bool_]:
    """Return a mask of the geoms that belong to robots, shape (ngeom,)."""
    by_joint = model.actuator_trntype == mujoco.mjtTrn.mjTRN_JOINT
    joints = model.actuator_trnid[by_joint, 0]
    roots = np.unique(model.body_rootid[model.jnt_bodyid[joints]])
    return np.isin(model.body_rootid[model.geom_bodyid], roots)


def _body(model: mujoco.MjModel, data: mujoco.MjData, geom: int) -> Body | None:
    """Return the bounding body of a geom; None for the ground and for invisible geoms."""
    is_drawn = model.geom_group[geom] in DRAWN_GROUPS and _alpha(model, geom) > 0.0
    if not is_drawn or model.geom_type[geom] == mujoco.mjtGeom.mjGEOM_PLANE:
        return None
    middle, half = model.geom_aabb[geom, :3], model.geom_aabb[geom, 3:]
    box = body_of(np.array([middle - half, middle + half])).corners
    body = body_of(box @ data.geom_xmat[geom].reshape(3, 3).T + data.geom_xpos[geom])
    length, width, height = np.subtract(body.high, body.low)
    is_ground = min(length, width) >= GROUND_M and height < GROUND_THICKNESS_M
    return None if is_ground else body


def _alpha(model: mujoco.MjModel, geom: int) -> float:
    material = int(model.geom_matid[geom])
    rgba = model.geom_rgba[geom] if material < 0 else model.mat_rgba[material]
    return float(rgba[3])


def _is_blocked(
    model: mujoco.MjModel,
    data: mujoco.MjData,
    of_robots: NDArray[np.bool_],
    start: Points,
    end: Points,
) -> bool:
    """Return whether something between two points hides one from the other."""
    groups = np.array([1, 1, 1, 0, 0, 0], dtype=np.uint8)
    line, geom, at = end - start, np.zeros(1, dtype=np.int32), 0.0
    for _ in range(MAX_HITS):
        hit = mujoco.mj_ray(model, data, start + at * line, line, groups, 1, -1, geom)
        if hit < 0.0 or at + hit >= 1.0:
            return False
        if not of_robots[geom[0]] and _alpha(model, int(geom[0])) >= OPAQUE:
            return True
        at += hit + STEP
    return True
