"""The foot: a square plate, four curved legs at its corners, a low pyramid between them."""

from itertools import pairwise

from manifold3d import Manifold

from meshes.part import BoxCollision, Part, Piece, beam_between, box_around, box_between
from meshes.solid import Point, bevelled_prism, bevelled_square, cylinder, prism, rectangle, union

HALF_WIDTH = 45.1
UNDERSIDE = -31.3
PLATE_TOP = -26.3
PYRAMID_TOP = -8.0
LEG_FOOT = -27.5
LEG_TOP = 48.676
LEG_SLICES = 8
LEG_SLICE_HEIGHT = 0.5
CORNERS = ((1, 1), (-1, 1), (-1, -1), (1, -1))


def foot() -> Part:
    """Return the link base_link."""
    plate = _plate()
    body = union([plate, _pyramid(), *map(_leg, CORNERS)])
    collisions = (
        box_around(plate),
        box_between((-20, -20, PLATE_TOP), (20, 20, PYRAMID_TOP)),
        *map(_leg_beam, CORNERS),
    )
    return Part("base_link", (Piece("base_link", "red", body),), collisions, body)


def _plate() -> Manifold:
    outline = rectangle((-HALF_WIDTH, -HALF_WIDTH), (HALF_WIDTH, HALF_WIDTH), corner=12.0)
    plate = bevelled_prism(outline, "z", UNDERSIDE, PLATE_TOP, bevel=1.2)
    screw_holes = [
        cylinder("z", centre, 2.0, UNDERSIDE - 1, PLATE_TOP + 1, segments=16)
        for centre in ((39.0, 0.0), (-39.0, 0.0), (0.0, 39.0), (0.0, -39.0))
    ]
    return plate - union(screw_holes)


def _pyramid() -> Manifold:
    base = prism(rectangle((-27, -27), (27, 27)), "z", PLATE_TOP - 1, PLATE_TOP)
    top = prism(rectangle((-9, -9), (9, 9)), "z", PYRAMID_TOP - 1, PYRAMID_TOP)
    cable_hole = cylinder("z", (0.0, 0.0), 5.0, PYRAMID_TOP - 10, PYRAMID_TOP + 1)
    return Manifold.batch_hull([base, top]) - cable_hole


def _leg(corner: tuple[int, int]) -> Manifold:
    slices = [_leg_slice(corner, i / LEG_SLICES) for i in range(LEG_SLICES + 1)]
    return union(Manifold.batch_hull(list(pair)) for pair in pairwise(slices))


def _leg_beam(corner: tuple[int, int]) -> BoxCollision:
    """Return a straight beam that holds most of the curved leg."""
    (x0, y0), (x1, y1) = _leg_centre(0.2), _leg_centre(1.0)
    start = (corner[0] * x0, corner[1] * y0, PLATE_TOP)
    return beam_between(start, (corner[0] * x1, corner[1] * y1, LEG_TOP - 1.0), width=12.0)


def _leg_slice(corner: tuple[int, int], height: float) -> Manifold:
    """Return a thin slice of a leg, at a height from 0, the plate, to 1, the top."""
    x, y = _leg_centre(height)
    half = 5.0 + 1.0 * (1.0 - height) ** 2
    outline = bevelled_square(half, bevel=1.8)
    start = LEG_FOOT + (LEG_TOP - LEG_SLICE_HEIGHT - LEG_FOOT) * height
    upright = outline.translate((corner[0] * x, corner[1] * y))
    return prism(upright, "z", start, start + LEG_SLICE_HEIGHT)


def _leg_centre(height: float) -> Point:
    """Return how far a leg is from the middle: it leans inwards, most of it near the plate."""
    inwards = 1.0 - (1.0 - height) ** 2.2
    return (38.0 - 14.5 * inwards, 38.0 - 6.5 * inwards)
