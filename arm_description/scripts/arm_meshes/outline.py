"""Outlines: the flat shapes that solids are cut from, in mm."""

from collections.abc import Iterable

import numpy as np
from manifold3d import CrossSection, JoinType

Point = tuple[float, float]

CIRCLE_SEGMENTS = 24
CORNER_SEGMENTS = 16
"""Of a full turn: a rounded corner has a quarter of them."""


def circle(centre: Point, radius: float, segments: int = CIRCLE_SEGMENTS) -> CrossSection:
    """Return a regular polygon with a corner on each axis."""
    return CrossSection.circle(radius, segments).translate(centre)


def rectangle(lower: Point, upper: Point, corner: float = 0.0) -> CrossSection:
    """Return an upright rectangle whose corners are rounded with a radius."""
    size = (upper[0] - lower[0] - 2 * corner, upper[1] - lower[1] - 2 * corner)
    core = CrossSection.square(size).translate((lower[0] + corner, lower[1] + corner))
    if corner == 0.0:
        return core
    return core.offset(corner, JoinType.Round, circular_segments=CORNER_SEGMENTS)


def polygon(points: Iterable[Point]) -> CrossSection:
    """Return a polygon; its corners are given counter-clockwise."""
    return CrossSection([np.array(list(points), dtype=np.float64)])


def bevelled_square(half_width: float, bevel: float) -> CrossSection:
    """Return a square around the origin whose corners are cut at 45 degrees."""
    far, near = half_width, half_width - bevel
    first: list[Point] = [(far, -near), (far, near)]
    corners = list(first)
    for _ in range(3):
        first = [(-y, x) for x, y in first]
        corners += first
    return polygon(corners)


def slot(start: Point, end: Point, radius: float) -> CrossSection:
    """Return what a round cutter leaves on the way from one point to another."""
    ends = [circle(start, radius, CORNER_SEGMENTS), circle(end, radius, CORNER_SEGMENTS)]
    return CrossSection.batch_hull(ends)
