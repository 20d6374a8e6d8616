"""How a free robot stands on the floor: its height, and whether it is balanced."""

from collections.abc import Iterable

import mujoco
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
GEOM = mujoco.mjtGeom

ON_FLOOR_M = 0.002
"""Points this close to the lowest one carry the robot."""
RIM_POINTS = 16
DIRECTIONS = 64
CORNERS = np.array([*np.ndindex(2, 2, 2)]) * 2.0 - 1.0
"""Of a box whose half sizes are 1."""


class FloorContact:
    """The points on which a body and its subtree can stand.

    `data` has valid positions of bodies and geoms, and centres of mass (`mj_comPos`).
    """

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData, root: int) -> None:
        points = [
            data.geom_xpos[geom] + _extremes(model, geom, rotation) @ rotation.T
            for geom in touching_geoms(model, model.body_rootid == root)
            for rotation in [data.geom_xmat[geom].reshape(3, 3)]
        ]
        self._points = np.concatenate(points) if points else np.zeros((0, 3))
        self._centre: Array = data.subtree_com[root, :2].copy()

    @property
    def lowest(self) -> float | None:
        """Lowest z in m; None for a robot without collision shapes."""
        return float(self._points[:, 2].min()) if len(self._points) else None

    def overhang(self) -> float:
        """Return how far the centre of mass is outside the feet in m; 0 or less if it is inside."""
        if not len(self._points):
            return 0.0
        feet = self._points[self._points[:, 2] <= self._points[:, 2].min() + ON_FLOOR_M, :2]
        angles = np.linspace(0.0, 2.0 * np.pi, DIRECTIONS, endpoint=False)
        directions = np.array([np.cos(angles), np.sin(angles)])
        # Inside the feet's hull, some foot is farther out than the centre in every direction.
        return float((-((feet - self._centre) @ directions).max(axis=0)).max())


def lowest_points(
    model: mujoco.MjModel, data: mujoco.MjData, geoms: Iterable[int]
) -> dict[int, float]:
    """Return the lowest z in m of each geom; the positions of geoms in `data` are valid."""
    heights: dict[int, float] = {}
    for geom in geoms:
        rotation = data.geom_xmat[geom].reshape(3, 3)
        points = data.geom_xpos[geom] + _extremes(model, geom, rotation) @ rotation.T
        heights[geom] = float(points[:, 2].min())
    return heights


def touching_geoms(model: mujoco.MjModel, bodies: NDArray[np.bool_]) -> list[int]:
    """Return the collision geoms of those bodies that a mask, shape (nbody,), chooses."""
    chosen = bodies[model.geom_bodyid] & (model.geom_contype != 0)
    geoms: list[int] = np.flatnonzero(chosen).tolist()
    return geoms


def _extremes(model: mujoco.MjModel, geom: int, rotation: Array) -> Array:
    """Return the candidates for a geom's lowest point, in its own frame, shape (k, 3)."""
    kind, size = model.geom_type[geom], model.geom_size[geom]
    down = -rotation[2]
    if kind == GEOM.mjGEOM_MESH:
        mesh = model.geom_dataid[geom]
        first = model.mesh_vertadr[mesh]
        return model.mesh_vert[first : first + model.mesh_vertnum[mesh]].astype(np.float64)
    if kind == GEOM.mjGEOM_SPHERE:
        return size[0] * down[None]
    if kind == GEOM.mjGEOM_ELLIPSOID:
        return (size**2 * down / np.linalg.norm(size * down))[None]
    ends = np.array([[0.0, 0.0, -size[1]], [0.0, 0.0, size[1]]])
    if kind == GEOM.mjGEOM_CAPSULE:
        return ends + size[0] * down
    if kind == GEOM.mjGEOM_CYLINDER:
        # The first point of the rim is the lowest one; the others follow around the rim.
        angles = np.arctan2(down[1], down[0]) + np.linspace(
            0, 2 * np.pi, RIM_POINTS, endpoint=False
        )
        rim = size[0] * np.array([np.cos(angles), np.sin(angles), np.zeros(RIM_POINTS)]).T
        return (ends[:, None] + rim[None]).reshape(-1, 3)
    return CORNERS * size
