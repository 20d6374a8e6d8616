"""Outlines and the solids cut from them, in mm: circles, polygons, boxes, prisms, cylinders."""

from collections.abc import Iterable
from typing import Literal

import numpy as np
from manifold3d import CrossSection, JoinType, Manifold

Point = tuple[float, float]

CIRCLE_SEGMENTS = 24
CORNER_SEGMENTS = 16
"""Segments of a full circle: a rounded corner has a quarter of them."""


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
    """Return the slot of a round cutter that moves from one point to another."""
    ends = [circle(start, radius, CORNER_SEGMENTS), circle(end, radius, CORNER_SEGMENTS)]
    return CrossSection.batch_hull(ends)


Axis = Literal["x", "y", "z"]
Vector = tuple[float, float, float]

TURN_Z_TO: dict[Axis, Vector] = {"x": (90, 0, 90), "y": (0, -90, -90), "z": (0, 0, 0)}
"""Rotations in degrees that keep the order of the axes: x is (y, z), y is (z, x), z is (x, y)."""


def box(lower: Vector, upper: Vector) -> Manifold:
    """Return a box between two opposite corners."""
    size = (upper[0] - lower[0], upper[1] - lower[1], upper[2] - lower[2])
    return Manifold.cube(size).translate(lower)


def bevelled_box(lower: Vector, upper: Vector, bevel: float) -> Manifold:
    """Return a box with all twelve edges cut at 45 degrees."""
    trimmed = []
    for axis in range(3):
        inset = [0.0 if i == axis else bevel for i in range(3)]
        trimmed.append(
            box(
                (lower[0] + inset[0], lower[1] + inset[1], lower[2] + inset[2]),
                (upper[0] - inset[0], upper[1] - inset[1], upper[2] - inset[2]),
            )
        )
    return Manifold.batch_hull(trimmed)


def prism(outline: CrossSection, axis: Axis, start: float, end: float) -> Manifold:
    """Return an outline pulled along an axis.

    The outline's two coordinates are the next two axes in cyclic order: along x they are (y, z),
    along y (z, x), along z (x, y).
    """
    upright = outline.extrude(end - start).translate((0.0, 0.0, start))
    return upright.rotate(TURN_Z_TO[axis])


def bevelled_prism(
    outline: CrossSection, axis: Axis, start: float, end: float, bevel: float
) -> Manifold:
    """Return a prism of a convex outline with the edges of its far end cut at 45 degrees."""
    top = prism(outline.offset(-bevel), axis, end - bevel, end)
    return Manifold.batch_hull([prism(outline, axis, start, end - bevel), top])


def cylinder(
    axis: Axis,
    centre: Point,
    radius: float,
    start: float,
    end: float,
    segments: int = CIRCLE_SEGMENTS,
) -> Manifold:
    """Return a cylinder; its centre is given in the two axes that `prism` names."""
    return prism(circle(centre, radius, segments), axis, start, end)


def union(solids: Iterable[Manifold]) -> Manifold:
    """Return the union of the solids."""
    total = Manifold()
    for solid in solids:
        total += solid
    return total
