"""One view of a depth camera, in terms of the plane that things stand on."""

from dataclasses import dataclass
from math import hypot

import numpy as np
from numpy.typing import NDArray

from arm_planning.perception.support_plane import Mask, Picture, SupportPlane

Array = NDArray[np.float64]
Window = tuple[slice, slice]
"""Rows and columns of a part of the picture."""


@dataclass(frozen=True, slots=True, eq=False)
class PlaneView:
    """Pictures of one shape (h, w), in a frame below the camera: x and y in the plane, z up.

    Attributes:
        plane: the support.
        heights: of the points above the plane, in m; nan where nothing is seen.
        depths: along the camera's axis, in m.
        rays: of depth 1, through all pixels, (h, w, 3).
        outside: pixels beyond the picture.
        apart: raised pixels of what is not looked for, but may hide a thing.
    """

    plane: SupportPlane
    heights: Picture
    depths: Picture
    rays: Picture
    outside: Mask
    apart: Mask

    @property
    def pixel(self) -> float:
        """Width of a pixel at depth 1."""
        return float(np.linalg.norm(self.rays[0, 1] - self.rays[0, 0]))

    def spots(self, window: Window, mask: Mask) -> Array:
        """Return where the points of some pixels are in the plane, (n, 2)."""
        depths = self.depths[window][mask]
        return (self.rays[window][mask][:, :2] * depths[:, None]).astype(np.float64)

    def noise(self, depth: float) -> float:
        """Return the standard deviation of a depth, in m."""
        return self.plane.noise * depth**2

    def level_noise(self, depth: float, level: float) -> float:
        """Return the standard deviation of a height, for points at a depth and about a height."""
        return self.plane.noise * depth * abs(self.plane.distance - level)

    def on_level(self, rays: Array, level: float) -> Array:
        """Return where rays (n, 3) meet a height above the plane, (n, 2)."""
        return rays[:, :2] * ((level - self.plane.distance) / rays[:, 2])[:, None]

    def steepness(self, spot: Array, level: float) -> float:
        """Return the slope at which the camera looks down at a place of some height."""
        return (self.plane.distance - level) / max(hypot(*spot), 1e-6)


def view_of(
    points: Picture, plane: SupportPlane, axes: Array, raised: Mask, apart: Mask
) -> tuple[PlaneView, Mask]:
    """Return the part of a camera's view with all raised pixels and one pixel around, and them.

    Args:
        points: (height, width, 3) in the camera's frame, nan where nothing is seen.
        plane: the support in that frame.
        axes: rows x, y, z of the plane's frame in the camera's.
        raised: (height, width), True somewhere.
        apart: (height, width), see `PlaneView`.
    """
    window: list[slice] = []
    margins: list[tuple[int, int]] = []
    for axis in (1, 0):
        lines = np.atleast_1d(raised.any(axis=axis))
        first, last = int(lines.argmax()), len(lines) - int(lines[::-1].argmax())
        window.append(slice(max(first - 1, 0), last + 1))
        margins.append((int(first == 0), int(last == len(lines))))
    rows, columns = window
    part: Picture = np.pad(points[rows, columns], (*margins, (0, 0)), constant_values=np.nan)
    depths = part[..., 2]
    rays: Picture = part / depths[..., None]
    missing = ~np.isfinite(depths)
    if missing.any():
        _add_rays(rays, missing)
    outside = np.pad(np.zeros(raised[rows, columns].shape, bool), margins, constant_values=True)
    turned: Picture = (rays @ axes.T).astype(np.float32)
    apart = np.pad(apart[rows, columns], margins)
    view = PlaneView(plane, plane.heights(part), depths, turned, outside, apart)
    return view, np.pad(raised[rows, columns], margins)


def _add_rays(rays: Picture, missing: Mask) -> None:
    """Set the rays of pixels without a point, those of a camera without distortion."""
    seen = np.nonzero(~missing)
    some = tuple(indices[:: max(1, len(indices) // 2000)] for indices in seen)
    rows, columns = np.nonzero(missing)
    for axis, (known, wanted) in enumerate(((some[1], columns), (some[0], rows))):
        line = np.polyfit(known, rays[(*some, axis)], 1)
        rays[rows, columns, axis] = np.polyval(line, wanted)
    rays[rows, columns, 2] = 1
