"""How deep a robot reaches, so that it can be stood on the floor."""

import mujoco
import numpy as np

GEOM = mujoco.mjtGeom


def lowest_point(model: mujoco.MjModel, data: mujoco.MjData, root: int) -> float | None:
    """Return the lowest z, in m, of what can be touched of a body and all it carries.

    Args:
        model: the model.
        data: positions of the geoms in it are read.
        root: id of the body.
    """
    lowest = None
    for geom in range(model.ngeom):
        if model.body_rootid[model.geom_bodyid[geom]] == root and model.geom_contype[geom]:
            bottom = data.geom_xpos[geom, 2] - _reach(model, geom, data.geom_xmat[geom, 6:9])
            lowest = bottom if lowest is None else min(lowest, bottom)
    return None if lowest is None else float(lowest)


def _reach(model: mujoco.MjModel, geom: int, up: np.ndarray) -> float:
    """Return how far a geom reaches below its centre; `up` is the world's z in its frame, (3,)."""
    kind, size = model.geom_type[geom], model.geom_size[geom]
    if kind == GEOM.mjGEOM_MESH:
        mesh = model.geom_dataid[geom]
        first = model.mesh_vertadr[mesh]
        vertices = model.mesh_vert[first : first + model.mesh_vertnum[mesh]]
        return -float((vertices @ up).min())
    if kind == GEOM.mjGEOM_SPHERE:
        return float(size[0])
    if kind == GEOM.mjGEOM_CAPSULE:
        return float(size[0] + abs(up[2]) * size[1])
    if kind == GEOM.mjGEOM_CYLINDER:
        return float(size[0] * np.hypot(up[0], up[1]) + abs(up[2]) * size[1])
    return float(np.abs(up) @ size)
