"""The turntable: the plate on the foot's legs, and the disc that turns on it and holds a servo."""

from manifold3d import Manifold

from meshes.arm.servo import CASE_LOWER, CASE_UPPER
from meshes.part import CylinderCollision, Part, Piece, box_around
from meshes.solid import (
    Point,
    bevelled_box,
    bevelled_prism,
    box,
    circle,
    cylinder,
    prism,
    rectangle,
    union,
)

PLATE_LOWER = (-28.53, -27.87)
PLATE_UPPER = (31.47, 50.38)
PLATE_UNDERSIDE = -1.94
PLATE_TOP = 3.0
RIM_TOP = 5.06
AXIS: Point = (0.0, 15.5)
"""Where j0 turns, in base_turn."""
BEARING_RADIUS = 21.0

DISC_RADIUS = 28.0
DISC_UNDERSIDE = -7.11
DISC_TOP = 0.9
POST_TOP = 13.59
POST_THICKNESS = 3.6
GAP = 0.05
"""Between the servo and what holds it."""


def plate() -> Part:
    """Return the link base_turn: a rounded plate with a large round hole and a rim around it."""
    slab = prism(rectangle(PLATE_LOWER, PLATE_UPPER, corner=9.0), "z", PLATE_UNDERSIDE, PLATE_TOP)
    rim = cylinder("z", AXIS, 26.0, PLATE_TOP - 1, RIM_TOP, segments=48)
    hole = cylinder("z", AXIS, BEARING_RADIUS, PLATE_UNDERSIDE - 1, RIM_TOP + 1, segments=48)
    body = slab + rim - hole - union(_screw_hole(x, y) for x in (-22, 25) for y in (-21, 44))
    return Part("base_turn", (Piece("base_turn", "red", body),), (box_around(body),), body)


def disc() -> Part:
    """Return the link base_turn_rot: a disc with four posts around the servo that stands on it."""
    outline = circle((0.0, 0.0), DISC_RADIUS, segments=48)
    slab = bevelled_prism(outline, "z", DISC_UNDERSIDE, DISC_TOP, bevel=1.0)
    pairs = [_post(sx, 1) + _post(sx, -1) for sx in (-1, 1)]
    body = slab + union(pairs) - _servo_pocket()
    height = DISC_TOP - DISC_UNDERSIDE
    collisions = (
        CylinderCollision((0.0, 0.0, DISC_UNDERSIDE + height / 2), DISC_RADIUS, height),
        *map(box_around, pairs),
    )
    piece = Piece("base_turn_table_rot", "red", body)
    return Part("base_turn_table_rot", (piece,), collisions, body)


def _screw_hole(x: float, y: float) -> Manifold:
    return cylinder("z", (x, y), 1.8, PLATE_UNDERSIDE - 1, PLATE_TOP + 1, segments=16)


def _post(sx: int, sy: int) -> Manifold:
    inner = CASE_UPPER[1] + GAP
    xs = sorted((sx * inner, sx * (inner + POST_THICKNESS)))
    ys = sorted((sy * 6.0, sy * 15.0))
    return bevelled_box((xs[0], ys[0], -1.0), (xs[1], ys[1], POST_TOP), bevel=0.8)


def _servo_pocket() -> Manifold:
    """Return the room of the servo: its y is the disc's x, its z the disc's y."""
    return box(
        (CASE_LOWER[1] - GAP, CASE_LOWER[2] - GAP, 0.0),
        (CASE_UPPER[1] + GAP, CASE_UPPER[2] + GAP, POST_TOP + 1),
    )
