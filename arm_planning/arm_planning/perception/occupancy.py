"""Occupied space, learned from one view of a depth camera after another.

As in OctoMap, each cube has the logarithm of the odds that it is occupied: a point in it raises
them, a line of sight through it lowers them, and both are bounded, so that things may come and go.
"""

import numpy as np
from numpy.typing import NDArray

from arm_node.rigid_transform import RigidTransform
from arm_planning.perception.support_plane import Picture
from arm_planning.scene.octree import HALF, Cells, Cubes

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

HIT, MISS = 0.85, -0.41
"""Odds of 0.7 and of 0.4."""
SUREST = 3.5
"""Odds of 0.97: nine views through a cube clear it."""
RAYS = 500
"""Pixels from which the camera's projection is taken."""


class OccupancyGrid:
    """Cubes, `resolution_m` wide, that are occupied more likely than not. One thread."""

    def __init__(self, resolution_m: float) -> None:
        self.resolution_m = resolution_m
        self._codes: Cells = np.empty(0, np.int64)
        self._odds: Array = np.empty(0)

    def clear(self) -> None:
        """Forget all."""
        self._codes, self._odds = self._codes[:0], self._odds[:0]

    def cubes(self) -> Cubes:
        """Return the occupied cubes."""
        return Cubes(_cells(self._codes), np.ones(len(self._codes), np.int64))

    def centres(self) -> Array:
        """Return their centres, (n, 3), in m."""
        return (_cells(self._codes).astype(np.float64) + 0.5) * self.resolution_m

    def see(self, points: Picture, camera: RigidTransform, obstacles: Mask) -> None:
        """Learn from a view.

        Args:
            points: (height, width, 3) in the optical frame, in m; infinite where nothing is, and
                nan where it is not known.
            camera: pose of that frame.
            obstacles: pixels whose points are occupied space, (height, width).
        """
        matrix = np.array(camera.matrix())
        placed = points[obstacles].astype(np.float64) @ matrix[:3, :3].T + matrix[:3, 3]
        hit = np.unique(_codes(np.floor(placed / self.resolution_m).astype(np.int64)))
        through = self._seen_through(points, matrix) & ~np.isin(self._codes, hit)
        codes = np.union1d(self._codes, hit)
        odds = np.zeros(len(codes))
        odds[np.searchsorted(codes, self._codes)] = self._odds + np.where(through, MISS, 0.0)
        odds[np.searchsorted(codes, hit)] += HIT
        self._keep(codes, np.minimum(odds, SUREST), odds > 0.0)

    def remove(self, gone: Mask) -> None:
        """Take cubes away, in the order of `centres`."""
        self._keep(self._codes, self._odds, ~gone)

    def _keep(self, codes: Cells, odds: Array, kept: Mask) -> None:
        self._codes, self._odds = codes[kept], odds[kept]

    def _seen_through(self, points: Picture, matrix: Array) -> Mask:
        """Return the cubes behind which a point is seen, or nothing at all."""
        x, y, z = ((self.centres() - matrix[:3, 3]) @ matrix[:3, :3]).T
        column_of, row_of = _projection(points)
        ahead = np.where(z > self.resolution_m, z, np.inf)
        columns = np.round(np.polyval(column_of, x / ahead)).astype(np.int64)
        rows = np.round(np.polyval(row_of, y / ahead)).astype(np.int64)
        height, width = points.shape[:2]
        inside = (ahead < np.inf) & (columns >= 0) & (columns < width) & (rows >= 0)
        inside &= rows < height
        through = np.zeros(len(z), bool)
        depths = points[rows[inside], columns[inside], 2]
        through[inside] = depths > z[inside] + self.resolution_m
        return through


def _projection(points: Picture) -> tuple[Array, Array]:
    """Return columns and rows as linear functions of x / z and y / z."""
    rows, columns = np.nonzero(np.isfinite(points[..., 2]) & (points[..., 2] > 0.0))
    if not len(rows) or rows[0] == rows[-1] or columns.min() == columns.max():
        # Nothing is seen from which directions could be taken: all lies outside of the picture.
        return np.array([0.0, -1.0]), np.array([0.0, -1.0])
    some = np.random.default_rng(0).integers(0, len(rows), RAYS)
    rows, columns = rows[some], columns[some]
    x, y, z = points[rows, columns].astype(np.float64).T
    return np.polyfit(x / z, columns, 1), np.polyfit(y / z, rows, 1)


def _codes(cells: Cells) -> Cells:
    """Return cells (n, 3) as sortable numbers; those beyond an octree are left out."""
    shifted = cells[((cells >= -HALF) & (cells < HALF)).all(axis=1)] + HALF
    return (shifted[:, 0] << 32) | (shifted[:, 1] << 16) | shifted[:, 2]


def _cells(codes: Cells) -> Cells:
    return np.column_stack([codes >> 32, codes >> 16 & 0xFFFF, codes & 0xFFFF]) - HALF
