"""The world's shapes as obstacles to the view."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

TOUCH = 1e-9


class Obstacles:
    """Oriented boxes, each solid or containing triangles, that block lines of sight.

    Args:
        rotations: rotations from the boxes' frames, shape (m, 3, 3).
        centres: centres in m, shape (m, 3).
        halves: half sides in m, shape (m, 3).
        triangles: for each box its triangles in the scene's frame (t, 3, 3); empty for a solid box.
    """

    def __init__(
        self, rotations: Array, centres: Array, halves: Array, triangles: Sequence[Array]
    ) -> None:
        self._rotations = rotations.reshape(-1, 3, 3)
        self._centres = centres.reshape(-1, 3)
        self._halves = halves.reshape(-1, 3)
        self._triangles = triangles

    def block(self, starts: Array, ends: Array) -> NDArray[np.bool_]:
        """Return whether the line from each start (n, 3) to its end (n, 3) is blocked, (n,)."""
        if not len(self._centres):
            return np.zeros(len(starts), dtype=bool)
        hit = self._boxes_hit(starts, ends)
        solid = np.array([not len(faces) for faces in self._triangles])
        blocked = np.zeros(len(starts), dtype=np.bool_)
        blocked |= hit[solid].any(axis=0)
        for box in np.flatnonzero(~solid & hit.any(axis=1)).tolist():
            lines = np.flatnonzero(np.logical_and(hit[box], ~blocked))
            if len(lines):
                blocked[lines] = _cross(self._triangles[box], starts[lines], ends[lines])
        return blocked

    def _boxes_hit(self, starts: Array, ends: Array) -> NDArray[np.bool_]:
        """Return which lines intersect which boxes, shape (m, n)."""
        begin = np.einsum("mji,mnj->mni", self._rotations, starts - self._centres[:, None])
        line = np.einsum("mji,nj->mni", self._rotations, ends - starts)
        line = np.where(np.abs(line) < TOUCH, TOUCH, line)
        halves = self._halves[:, None]
        near, far = (-halves - begin) / line, (halves - begin) / line
        enter = np.minimum(near, far).max(axis=-1)
        leave = np.maximum(near, far).min(axis=-1)
        return (enter < leave) & (leave > 0.0) & (enter < 1.0)


def _cross(triangles: Array, starts: Array, ends: Array) -> NDArray[np.bool_]:
    """Return which lines cross any of the triangles, by Moeller and Trumbore's method."""
    corner, first, second = (
        triangles[:, 0],
        triangles[:, 1] - triangles[:, 0],
        triangles[:, 2] - triangles[:, 0],
    )
    crossed = np.zeros(len(starts), dtype=bool)
    for i, (start, line) in enumerate(zip(starts, ends - starts, strict=True)):
        normal = np.cross(line, second)
        determinant = np.einsum("ti,ti->t", first, normal)
        flat = np.abs(determinant) < TOUCH
        inverse = 1.0 / np.where(flat, 1.0, determinant)
        offset = start - corner
        u = np.einsum("ti,ti->t", offset, normal) * inverse
        across = np.cross(offset, first)
        v = across @ line * inverse
        at = np.einsum("ti,ti->t", second, across) * inverse
        inside = (u >= 0.0) & (v >= 0.0) & (u + v <= 1.0) & (at > 0.0) & (at < 1.0)
        crossed[i] = bool((inside & ~flat).any())
    return crossed
