"""The shapes of objects; boxes, cylinders and spheres are those of a URDF."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from arm_description.urdf.robot import Box, Cylinder, Sphere

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Cone:
    """A cone along z, centred at half its height, its tip up, in m."""

    radius: float
    height: float


@dataclass(frozen=True, slots=True)
class Plane:
    """All points with a x + b y + c z + d <= 0: a half space, its normal (a, b, c)."""

    a: float
    b: float
    c: float
    d: float


@dataclass(frozen=True, slots=True, eq=False)
class TriangleMesh:
    """A surface of triangles.

    Attributes:
        vertices: corners in m, (n, 3), read-only.
        triangles: indices of each triangle's corners, (m, 3), read-only.
    """

    vertices: Array
    triangles: NDArray[np.int64]

    def __post_init__(self) -> None:
        self.vertices.setflags(write=False)
        self.triangles.setflags(write=False)


Shape = Box | Sphere | Cylinder | Cone | Plane | TriangleMesh
