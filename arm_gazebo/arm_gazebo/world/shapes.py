"""The shapes of a world, without robots, as simple solids that any viewer can draw."""

from collections.abc import Iterator
from dataclasses import field
from enum import Enum

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_description.mesh.data import MeshData
from arm_gazebo.mesh.simplification import simplified
from arm_gazebo.rendering.surface_colours import flat_colours
from arm_gazebo.world.entity import WORLD_FRAME, Entities
from arm_node.frozen import frozen

DRAWN_GROUPS = (0, 1, 2)
"""The groups that MuJoCo's viewers and the cameras show."""
INFINITE_PLANE_M = 20.0
"""Side of the box that represents an infinite plane."""
THICKNESS_M = 1e-3
MAX_TRIANGLES = 2000
"""Limit on the triangles of one mesh: a browser needs no more, and messages must stay small."""
GEOM = mujoco.mjtGeom


class Solid(Enum):
    """The kinds of solids."""

    BOX = "box"
    BALL = "ball"
    CYLINDER = "cylinder"
    TRIANGLES = "triangles"


@frozen
class WorldShape:
    """A solid of the world.

    Attributes:
        owner: the entity, or "world".
        number: number of the shape within its owner; the same in every model that has both.
        solid: kind of solid.
        size: full sides in m, shape (3,); 1 each for triangles.
        rgba: colour.
        geom: index of the geom whose pose it follows.
        offset: position of its centre in the frame of the geom, shape (3,).
        corners: corners of triangles, three points each, shape (3 n, 3).
    """

    owner: str
    number: int
    solid: Solid
    size: tuple[float, float, float]
    rgba: tuple[float, float, float, float]
    geom: int
    offset: tuple[float, float, float] = (0.0, 0.0, 0.0)
    corners: NDArray[np.float64] = field(default_factory=lambda: np.empty((0, 3)))

    @property
    def key(self) -> tuple[str, int]:
        """The unique key of the shape."""
        return self.owner, self.number


class WorldShapes:
    """All shapes of one model except those of robots, and their poses."""

    def __init__(self, model: mujoco.MjModel, entities: Entities) -> None:
        self.shapes = tuple(_shapes(model, entities))
        self._geoms = np.array([shape.geom for shape in self.shapes], dtype=np.intp)
        self._offsets = np.array([shape.offset for shape in self.shapes]).reshape(-1, 3)

    def poses(
        self, positions: NDArray[np.float64], rotations: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """Return positions and quaternions (x, y, z, w) of the shapes, shape (n, 7).

        `positions` (ngeom, 3) and `rotations` (ngeom, 9) are those of all geoms.
        """
        poses = np.empty((len(self.shapes), 7))
        turned = rotations[self._geoms].reshape(-1, 3, 3)
        poses[:, :3] = positions[self._geoms] + np.einsum("nij,nj->ni", turned, self._offsets)
        quaternion = np.empty(4)
        for row, geom in enumerate(self._geoms.tolist()):
            mujoco.mju_mat2Quat(quaternion, rotations[geom])
            poses[row, 3:6], poses[row, 6] = quaternion[1:], quaternion[0]
        return poses


def _shapes(model: mujoco.MjModel, entities: Entities) -> Iterator[WorldShape]:
    owners = {0: WORLD_FRAME}
    for entity in entities:
        if not entity.is_robot:
            owners.update({model.body(root).id: entity.name for root in entity.roots})
    colours = flat_colours(model)
    numbers = dict.fromkeys(owners.values(), 0)
    for geom in range(model.ngeom):
        owner = owners.get(int(model.body_rootid[model.geom_bodyid[geom]]))
        rgba = tuple(colours[geom].tolist())
        if owner is None or model.geom_group[geom] not in DRAWN_GROUPS or not rgba[3]:
            continue
        for solid, size, offset, corners in _solids(model, geom):
            number = numbers[owner]
            numbers[owner] += 1
            yield WorldShape(owner, number, solid, size, rgba, geom, offset, corners)


_Solid = tuple[Solid, tuple[float, float, float], tuple[float, float, float], NDArray[np.float64]]
NO_CORNERS = np.empty((0, 3))
HERE = (0.0, 0.0, 0.0)


def _solids(model: mujoco.MjModel, geom: int) -> Iterator[_Solid]:
    """Yield the solids that make up a geom; rare kinds of geoms yield nothing."""
    x, y, z = model.geom_size[geom].tolist()
    match GEOM(int(model.geom_type[geom])):
        case GEOM.mjGEOM_BOX:
            yield Solid.BOX, (2 * x, 2 * y, 2 * z), HERE, NO_CORNERS
        case GEOM.mjGEOM_SPHERE:
            yield Solid.BALL, (2 * x, 2 * x, 2 * x), HERE, NO_CORNERS
        case GEOM.mjGEOM_ELLIPSOID:
            yield Solid.BALL, (2 * x, 2 * y, 2 * z), HERE, NO_CORNERS
        case GEOM.mjGEOM_CYLINDER:
            yield Solid.CYLINDER, (2 * x, 2 * x, 2 * y), HERE, NO_CORNERS
        case GEOM.mjGEOM_CAPSULE:
            yield Solid.CYLINDER, (2 * x, 2 * x, 2 * y), HERE, NO_CORNERS
            for end in (y, -y):
                yield Solid.BALL, (2 * x, 2 * x, 2 * x), (0.0, 0.0, end), NO_CORNERS
        case GEOM.mjGEOM_PLANE:
            sides = (2 * x or INFINITE_PLANE_M, 2 * y or INFINITE_PLANE_M, THICKNESS_M)
            yield Solid.BOX, sides, (0.0, 0.0, -THICKNESS_M / 2), NO_CORNERS
        case GEOM.mjGEOM_MESH:
            corners = _corners(model, int(model.geom_dataid[geom]))
            if len(corners):
                yield Solid.TRIANGLES, (1.0, 1.0, 1.0), HERE, corners


def _corners(model: mujoco.MjModel, mesh: int) -> NDArray[np.float64]:
    """Return the corners of a mesh's triangles, three by three, shape (3 n, 3)."""
    first, count = int(model.mesh_vertadr[mesh]), int(model.mesh_vertnum[mesh])
    vertices = model.mesh_vert[first : first + count].astype(np.float64)
    first, count = int(model.mesh_faceadr[mesh]), int(model.mesh_facenum[mesh])
    faces = model.mesh_face[first : first + count].astype(np.int32)
    if not len(faces):
        return NO_CORNERS
    drawn = simplified(MeshData(vertices, faces, None), MAX_TRIANGLES)
    return drawn.vertices[drawn.faces].reshape(-1, 3)
