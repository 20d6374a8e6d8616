"""Triangles in memory: what every mesh file becomes."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from arm_description.errors import MeshFileError

FEWEST_VERTICES = 4
Color = tuple[float, float, float, float]
Scale = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class MeshData:
    """One part of a mesh file, of one colour.

    Attributes:
        vertices: shape (v, 3), m.
        faces: shape (f, 3), indices of vertices, counter-clockwise seen from outside.
        rgba: colour that the file gives, None if it gives none.
    """

    vertices: NDArray[np.float64]
    faces: NDArray[np.int32]
    rgba: Color | None = None

    def scaled(self, scale: Scale) -> "MeshData":
        """Return the mesh scaled along its axes; a mirrored one keeps its outside outside."""
        faces = self.faces[:, ::-1] if np.prod(scale) < 0 else self.faces
        return MeshData(self.vertices * scale, faces, self.rgba)

    @property
    def bounds(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Lowest and highest coordinates, shapes (3,)."""
        return self.vertices.min(axis=0), self.vertices.max(axis=0)

    def check(self) -> None:
        """Raise a MeshFileError that says why nobody could draw this mesh."""
        if self.vertices.shape[1:] != (3,) or self.faces.shape[1:] != (3,):
            raise MeshFileError("a vertex without three coordinates or a face that is no triangle")
        if len(self.vertices) < FEWEST_VERTICES or not len(self.faces):
            raise MeshFileError(
                f"only {len(self.vertices)} vertices and {len(self.faces)} triangles"
            )
        if not np.isfinite(self.vertices).all():
            raise MeshFileError("a vertex that is not finite")
        if self.faces.min() < 0 or self.faces.max() >= len(self.vertices):
            raise MeshFileError("a triangle of a vertex that does not exist")
        sides = self.vertices[self.faces[:, 1:]] - self.vertices[self.faces[:, :1]]
        if not np.cross(sides[:, 0], sides[:, 1]).any():
            raise MeshFileError("no triangle with an area")


def merged(vertices: NDArray[np.float32], rgba: Color | None = None) -> MeshData:
    """Return the mesh of loose triangles whose equal corners are one vertex.

    Args:
        vertices: shape (3 f, 3), three rows for each triangle.
        rgba: colour of the mesh.
    """
    with np.errstate(invalid="ignore"):  # what is no number is told by `check`
        rows = np.ascontiguousarray(vertices + np.float32(0))  # -0 and 0 are the same place
    keys = rows.view(np.dtype((np.void, rows.dtype.itemsize * 3))).ravel()
    _, first, index = np.unique(keys, return_index=True, return_inverse=True)
    return MeshData(rows[first].astype(np.float64), index.reshape(-1, 3).astype(np.int32), rgba)
