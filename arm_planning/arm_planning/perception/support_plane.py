"""The plane that things stand on, found in a depth camera's points."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from arm_planning.errors import PerceptionError

Array = NDArray[np.float64]
Picture = NDArray[np.float32]
Mask = NDArray[np.bool_]

SAMPLES = 4000
TRIPLES = 200
REFINEMENTS = 4
DEVIATION_PER_MEDIAN = 1.4826
"""Standard deviation of a normal distribution per median of the absolute errors."""
MAX_TILT_RAD = 0.2
"""A plane that leans more than this from the level is a wall or a ramp, not a support."""
RANDOM_DEPTH_PER_M = 0.003
"""Noise of a depth camera at 1 m that the first search allows; the plane's own noise follows."""
LEAST_SHARE = 0.1
"""Share of the points that must lie on a plane, so that it counts as one."""


@dataclass(frozen=True, slots=True)
class SupportPlane:
    """A plane in the frame of the camera, which is at the origin above it.

    Attributes:
        normal: unit vector away from the support, on the camera's side.
        distance: of the camera from the plane, in m.
        noise: standard deviation of a depth at 1 m, in m; it grows with the square of the depth.
    """

    normal: tuple[float, float, float]
    distance: float
    noise: float

    def heights(self, points: Picture) -> Picture:
        """Return how far points (..., 3) are above the plane, in m."""
        return points @ np.array(self.normal, np.float32) + np.float32(self.distance)


def find_support_plane(points: Picture, up: Array, apart: Mask) -> SupportPlane:
    """Return the level plane below the camera that has the most points.

    Args:
        points: (height, width, 3), in m, nan where nothing is seen; z looks ahead.
        up: unit vector, in the points' frame.
        apart: (height, width), pixels that are left out.

    Raises:
        PerceptionError: fewer points than a plane needs, or no level plane among them.
    """
    step = max(1, int((points.shape[0] * points.shape[1] / SAMPLES) ** 0.5))
    grid = (slice(step // 2, None, step),) * 2
    some = points[grid][~apart[grid] & np.isfinite(points[grid][..., 2])].astype(np.float64)
    if len(some) < 3:
        raise PerceptionError("the depth camera sees no points")
    normal, distance = _best_of_triples(some, up)
    for _ in range(REFINEMENTS):
        scale = some[:, 2] * distance
        near = np.abs(some @ normal + distance) < 4 * RANDOM_DEPTH_PER_M * scale + 0.001
        if near.sum() < max(3, LEAST_SHARE * len(some)):
            raise PerceptionError(
                "the depth camera sees no level plane: the largest has "
                f"{100 * near.mean():.0f} % of its points"
            )
        weight = 1 / (scale[near] + 1e-3)
        centre = np.average(some[near], axis=0, weights=weight**2)
        _, _, axes = np.linalg.svd((some[near] - centre) * weight[:, None], full_matrices=False)
        normal = axes[2] * np.sign(axes[2] @ up)
        distance = -float(normal @ centre)
    # A depth's error moves a point of the plane by error / depth * distance along the normal.
    errors = np.abs(some @ normal + distance) / (some[:, 2] * distance)
    spread = float(np.median(errors[errors < 4 * RANDOM_DEPTH_PER_M]))
    return SupportPlane(tuple(normal.tolist()), distance, DEVIATION_PER_MEDIAN * spread)


def _best_of_triples(points: Array, up: Array) -> tuple[Array, float]:
    """Return the level plane through three of the points that most others are near."""
    random = np.random.default_rng(0)
    first, second, third = points[random.integers(0, len(points), (3, TRIPLES))]
    normals = np.cross(second - first, third - first)
    lengths = np.linalg.norm(normals, axis=1)
    normals /= np.where(lengths > 0, lengths, 1)[:, None]
    normals *= np.sign(normals @ up)[:, None]
    distances = -np.einsum("ij,ij->i", normals, first)
    usable = (lengths > 0) & (normals @ up > np.cos(MAX_TILT_RAD)) & (distances > 0)
    if not usable.any():
        raise PerceptionError("the depth camera sees no level plane below itself")
    normals, distances = normals[usable], distances[usable]
    tolerance = 2 * RANDOM_DEPTH_PER_M * np.abs(points[:, 2])[:, None] * distances + 0.001
    counts = (np.abs(points @ normals.T + distances) < tolerance).sum(axis=0)
    best = int(counts.argmax())
    return normals[best], float(distances[best])
