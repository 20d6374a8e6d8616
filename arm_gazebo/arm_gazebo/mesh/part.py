"""One part of a mesh file prepared for MuJoCo: its visual triangles and its collision hull."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from arm_description.errors import MeshFileError
from arm_description.mesh.data import UNSCALED, MeshData, Scale
from arm_gazebo.errors import MeshError
from arm_gazebo.mesh.simplification import outermost, simplified
from arm_node.frozen import frozen

MAX_EXTENT_M = 1e3
MIN_SIZE_M = 1e-6
FLAT = 1e-6
"""Ratio of thickness to size below which a mesh has no convex hull."""
ROUNDING = 8 * float(np.finfo(np.float32).eps)
"""Ratio of thickness to distance from the origin below which a mesh has no convex hull, because
MuJoCo stores vertices in single precision."""
MIN_HALF_THICKNESS_M = 1e-4
"""Half the thickness that a flat mesh gets so that it can collide."""


@frozen
class MeshPart:
    """A part of one colour.

    Attributes:
        drawn: the triangles of the visual.
        hull: vertices whose convex hull is the collision shape, shape (h, 3), m.
        triangles: number of triangles in the file, before simplification.
        different: number of drawn triangles with different corners.
    """

    drawn: MeshData
    hull: NDArray[np.float64]
    triangles: int
    different: int

    @classmethod
    def of(cls, mesh: MeshData) -> "MeshPart":
        """Return the part made from a mesh.

        Raises:
            MeshError: MuJoCo cannot draw the mesh; the message says why.
        """
        try:
            mesh.check()
            drawn = simplified(mesh)
        except MeshFileError as error:
            raise MeshError(str(error)) from error
        return cls(drawn, outermost(mesh.vertices), len(mesh.faces), drawn.different_faces())

    def scaled(self, scale: Scale) -> "MeshPart":
        """Return the part scaled along its axes, in m.

        Raises:
            MeshError: the part is too large or too small for MuJoCo's arithmetic.
        """
        part = self
        if scale != UNSCALED:
            part = replace(self, drawn=self.drawn.scaled(scale), hull=self.hull * scale)
        low, high = part.bounds
        farthest = float(max(-low.min(), high.max()))
        size = float((high - low).max())
        if not farthest < MAX_EXTENT_M:
            raise MeshError(
                f"it extends {farthest:.3g} m from its origin; the limit is {MAX_EXTENT_M:g} m"
            )
        if not size > MIN_SIZE_M:
            raise MeshError(f"it is only {size:.3g} m large")
        return part

    @property
    def bounds(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Lowest and highest coordinates, shapes (3,)."""
        return self.hull.min(axis=0), self.hull.max(axis=0)

    def is_small(self) -> bool:
        """Return whether the visual triangles serve as the collision shape as well."""
        return len(self.hull) == len(self.drawn.vertices)

    def is_flat(self) -> bool:
        """Return whether all vertices lie nearly in one plane, so that there is no convex hull."""
        return len(self._thin_axes()) > 0

    def lies_along_axes(self) -> bool:
        """Return whether a flat part is flat along an axis of its frame, so that a box fits it."""
        return bool((np.abs(self._thin_axes()).max(axis=1) > 1.0 - FLAT).all())

    def thickened(self) -> "MeshPart":
        """Return the part with a volume: a plane becomes a sheet, a line a rod, a point a cube."""
        hull = self.hull
        half = max(MIN_HALF_THICKNESS_M, 4 * ROUNDING * float(np.abs(hull).max()))
        for axis in self._thin_axes():
            hull = np.concatenate([hull - half * axis, hull + half * axis])
        return replace(self, hull=hull)

    def _thin_axes(self) -> NDArray[np.float64]:
        """Return the unit vectors along which the hull has no thickness, shape (n, 3)."""
        spread = self.hull - self.hull.mean(axis=0)
        _, axes = np.linalg.eigh(spread.T @ spread)
        sizes = np.ptp(spread @ axes, axis=0)
        least = max(FLAT * float(sizes.max()), ROUNDING * float(np.abs(self.hull).max()))
        return axes.T[sizes <= least]
