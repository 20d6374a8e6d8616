"""Round housings: what the arm's tubes, joints and caps are made of, in mm."""

import math

from arm_meshes.outline import Point
from arm_meshes.solid import Axis, cylinder
from manifold3d import Manifold

SEGMENTS = 48
FILLET_STEPS = 5
SUNK = 0.6
"""How far the disc of a cap lies below the cap's face."""
MARGIN = 4.0
"""Between the disc of a cap and the housing's side."""


def housing(
    axis: Axis, centre: Point, radius: float, open_end: float, capped_end: float, fillet: float
) -> Manifold:
    """Return a cylinder whose capped end has a rounded edge; either end may be the upper one."""
    way = math.copysign(1.0, capped_end - open_end)
    slices = [_slice(axis, centre, radius, open_end, capped_end - way * fillet)]
    for step in range(1, FILLET_STEPS + 1):
        angle = math.pi / 2 * step / FILLET_STEPS
        face = capped_end - way * fillet * (1 - math.sin(angle))
        inset = fillet * (1 - math.cos(angle))
        slices.append(_slice(axis, centre, radius - inset, open_end, face))
    return Manifold.batch_hull(slices)


def cap_disc(
    axis: Axis, centre: Point, radius: float, capped_end: float, inside: float
) -> tuple[Manifold, Manifold]:
    """Return the room for a disc in a housing's face, and the disc that lies in it.

    Args:
        axis: the housing's.
        centre: in the two axes that `prism` names.
        radius: of the housing.
        capped_end: where its face is.
        inside: any place on the axis that is inside the housing.
    """
    way = math.copysign(1.0, capped_end - inside)
    room = _slice(axis, centre, radius - MARGIN, capped_end - way * 3.0, capped_end + way)
    disc = _slice(
        axis, centre, radius - MARGIN - 0.15, capped_end - way * 3.2, capped_end - way * SUNK
    )
    return room, disc


def _slice(axis: Axis, centre: Point, radius: float, start: float, end: float) -> Manifold:
    return cylinder(axis, centre, radius, min(start, end), max(start, end), SEGMENTS)
