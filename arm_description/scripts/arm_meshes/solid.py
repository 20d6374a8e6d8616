"""Solids: boxes, prisms and what joins them, in mm."""

from collections.abc import Iterable
from typing import Literal

from manifold3d import CrossSection, Manifold

from arm_meshes.outline import CIRCLE_SEGMENTS, Point, circle

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
    """Return what any of the solids fills."""
    total = Manifold()
    for solid in solids:
        total += solid
    return total
