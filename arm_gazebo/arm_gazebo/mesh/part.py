"""One part of a mesh file, ready for MuJoCo: what is drawn, and what is touched."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from arm_description.errors import MeshFileError
from arm_description.mesh_data import MeshData, Scale
from arm_gazebo.errors import MeshError
from arm_gazebo.mesh.simplification import outermost, simplified

FARTHEST_M = 1e3
SMALLEST_M = 1e-6
FLAT = 1e-9
"""Thickness over size below which a mesh has no convex hull."""


@dataclass(frozen=True, slots=True)
class MeshPart:
    """A part of one colour.

    Attributes:
        drawn: the triangles to be seen.
        hull: vertices whose convex hull is touched, shape (h, 3), m.
        triangles: how many the file has; more than are drawn where those were too many.
    """

    drawn: MeshData
    hull: NDArray[np.float64]
    triangles: int

    @classmethod
    def of(cls, mesh: MeshData) -> "MeshPart":
        """Return the part that a mesh makes.

        Raises:
            MeshError: MuJoCo could not draw it; the message says why.
        """
        try:
            mesh.check()
        except MeshFileError as error:
            raise MeshError(str(error)) from error
        return cls(simplified(mesh), outermost(mesh.vertices), len(mesh.faces))

    def scaled(self, scale: Scale) -> "MeshPart":
        """Return the part scaled along its axes, in m.

        Raises:
            MeshError: it is of no size that a part can have; MuJoCo's sums would not bear it.
        """
        part = MeshPart(self.drawn.scaled(scale), self.hull * scale, self.triangles)
        farthest = float(np.abs(part.hull).max())
        size = float(np.ptp(part.hull, axis=0).max())
        if not farthest < FARTHEST_M:
            raise MeshError(f"it reaches {farthest:.3g} m far; at most {FARTHEST_M:g} m are used")
        if not size > SMALLEST_M:
            raise MeshError(f"it is only {size:.3g} m large")
        return part

    @property
    def bounds(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Lowest and highest coordinates, shapes (3,)."""
        return self.hull.min(axis=0), self.hull.max(axis=0)

    def is_small(self) -> bool:
        """Whether what is drawn can be touched as it is."""
        return len(self.hull) == len(self.drawn.vertices)

    def is_flat(self) -> bool:
        """Whether all vertices lie in one plane, so that there is no convex hull."""
        spread = self.hull - self.hull.mean(axis=0)
        eigenvalues = np.linalg.eigvalsh(spread.T @ spread / len(spread))
        return bool(np.sqrt(max(eigenvalues[0], 0.0)) <= FLAT + 1e-6 * np.sqrt(eigenvalues[2]))
