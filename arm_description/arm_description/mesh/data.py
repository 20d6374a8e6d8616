"""Triangles in memory, which every mesh file is converted to."""

import warnings
from typing import Any

import numpy as np
from numpy.typing import NDArray

from arm_description.errors import MeshFileError
from arm_node.frozen import frozen

LARGEST_BYTES = 500_000_000
"""Maximum size of a mesh file, also after unpacking."""
MIN_VERTICES = 4
FACES_AT_ONCE = 10_000
_HASH = np.array([0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9], np.uint64)
"""Odd factors that hash three numbers to 64 bits."""
Color = tuple[float, float, float, float]
Scale = tuple[float, float, float]
UNSCALED: Scale = (1.0, 1.0, 1.0)


@frozen
class MeshData:
    """One part of a mesh file, of one colour.

    Attributes:
        vertices: shape (v, 3), m.
        faces: shape (f, 3), indices of vertices, counter-clockwise seen from outside.
        rgba: colour in the file, None if there is none.
    """

    vertices: NDArray[np.float64]
    faces: NDArray[np.int32]
    rgba: Color | None = None

    def scaled(self, scale: Scale) -> "MeshData":
        """Return the mesh scaled along its axes; mirroring keeps the faces' outside."""
        faces = self.faces[:, ::-1] if np.prod(scale) < 0 else self.faces
        return MeshData(self.vertices * scale, faces, self.rgba)

    @property
    def bounds(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Lowest and highest coordinates, shapes (3,)."""
        return self.vertices.min(axis=0), self.vertices.max(axis=0)

    def check(self) -> None:
        """Raise a MeshFileError that says why this mesh cannot be drawn."""
        if self.vertices.shape[1:] != (3,) or self.faces.shape[1:] != (3,):
            raise MeshFileError("a vertex lacks coordinates, or a face is not a triangle")
        if len(self.vertices) < MIN_VERTICES or not len(self.faces):
            raise MeshFileError(
                f"too few vertices ({len(self.vertices)}) or triangles ({len(self.faces)})"
            )
        if not np.isfinite(self.vertices).all():
            raise MeshFileError("a vertex is not finite")
        if self.faces.min() < 0 or self.faces.max() >= len(self.vertices):
            raise MeshFileError("a triangle has a vertex that does not exist")
        if not any(self._has_area(start) for start in range(0, len(self.faces), FACES_AT_ONCE)):
            raise MeshFileError("no triangle with an area")

    def different_faces(self) -> int:
        """Return the number of triangles with different corners, in whatever order.

        Corners are compared by their place, because some formats give each triangle its own.
        """
        bits = np.ascontiguousarray(self.vertices + 0.0).view(np.uint64)  # -0 and 0 are the same.
        # Round numbers differ in their highest bits only, and a product carries nothing downwards.
        corners = (_folded(bits) * _HASH).sum(axis=1)
        # Without more of it, triangles whose corners have the same sum would have the same hash.
        corners = _folded(_folded(_folded(corners) * _HASH[1]) * _HASH[2])
        keys = np.sort(corners[self.faces].sum(axis=1))
        return int(np.count_nonzero(np.diff(keys))) + min(len(keys), 1)

    def _has_area(self, start: int) -> bool:
        faces = self.faces[start : start + FACES_AT_ONCE]
        sides = self.vertices[faces[:, 1:]] - self.vertices[faces[:, :1]]
        return bool(np.cross(sides[:, 0], sides[:, 1]).any())


def _folded(bits: NDArray[np.uint64]) -> NDArray[np.uint64]:
    return bits ^ (bits >> np.uint64(32))


def numbers_in(text: bytes | str, what: str, kind: type) -> NDArray[Any]:
    """Return the numbers of a text that are separated by white space.

    Args:
        text: the text.
        what: what one of them is, for the message.
        kind: numpy's type of the numbers.

    Raises:
        MeshFileError: something else stands between them.
    """
    with warnings.catch_warnings():
        # numpy only warns where it stops at what is no number.
        warnings.simplefilter("error", DeprecationWarning)
        try:
            words = text if isinstance(text, str) else text.decode("ascii")
            return np.fromstring(words, dtype=kind, sep=" ")
        except (ValueError, DeprecationWarning) as error:
            raise MeshFileError(f"{what} is not a number: {error}") from error


def merged(vertices: NDArray[np.float32]) -> MeshData:
    """Return a mesh from separate triangles, with equal corners merged into one vertex.

    Args:
        vertices: shape (3 f, 3), three rows for each triangle.
    """
    with np.errstate(invalid="ignore"):  # `check` reports NaN.
        rows = np.ascontiguousarray(vertices + np.float32(0))  # -0 and 0 are the same.
    first, index = _unique(rows)
    return MeshData(rows[first].astype(np.float64), index.reshape(-1, 3).astype(np.int32))


def _unique(rows: NDArray[np.float32]) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return the indices of the unique rows, and for each row the unique one that it equals."""
    bits = rows.view(np.uint32)
    # Each row is hashed to one number, because numbers sort ten times faster than rows. Going
    # column by column takes half the memory of converting all three at once.
    keys = bits[:, 0] * _HASH[0] + bits[:, 1] * _HASH[1] + bits[:, 2] * _HASH[2]
    _, first, index = np.unique(keys, return_index=True, return_inverse=True)
    index = index.reshape(-1)
    if (bits == bits[first[index]]).all():
        return first, index
    # Two different rows have the same hash.
    whole = rows.view(np.dtype((np.void, rows.dtype.itemsize * 3))).ravel()
    _, first, index = np.unique(whole, return_index=True, return_inverse=True)
    return first, index.reshape(-1)
