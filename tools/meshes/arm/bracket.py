"""The U brackets f4 and f5: two ears on a servo's horn, a cup around the tail of the next servo."""

from manifold3d import CrossSection, Manifold

from meshes.part import Part, Piece, box_around
from meshes.solid import box, circle, cylinder, prism, rectangle, slot, union

LEFT, RIGHT = -27.35, 20.65
"""The outer faces; the horn is at the left ear."""
LEFT_INNER, RIGHT_INNER = -24.1, 17.1
"""The ears clear the servo between them in both links, whose origins differ by 1 mm."""
EAR_Y = -46.5
EAR_RADIUS = 13.8
EAR_HALF_WIDTH = 14.3
TOP = 31.34
PLATE_LOWER, PLATE_UPPER = 22.0, 25.95
"""The servo's tail stands on the plate's upper side."""
SERVO_LEFT, SERVO_RIGHT = -21.05, 14.05
STEP = 0.05
"""Faces that would lie in one plane are this far apart, so that the union stays closed."""


def bracket() -> Part:
    """Return the links f4 and f5."""
    left = _ear(LEFT, LEFT_INNER, hole=5.0)
    right = _ear(RIGHT_INNER, RIGHT, hole=4.0)
    cup = _cup()
    body = union([left, right, cup])
    plate = box((LEFT, PLATE_LOWER, -EAR_HALF_WIDTH), (RIGHT, PLATE_UPPER, EAR_HALF_WIDTH))
    collisions = (box_around(left), box_around(right), box_around(plate))
    return Part("f4_n_f3", (Piece("f4_n_f3", "red", body),), collisions, body)


def _ear(start: float, end: float, hole: float) -> Manifold:
    """Return a side of the U: an outline in (y, z) with a round end."""
    outline = _ear_outline() - circle((EAR_Y, 0.0), hole)
    for dy, dz in ((8.0, 0.0), (0.0, 8.0), (-8.0, 0.0), (0.0, -8.0)):
        outline -= circle((EAR_Y + dy, dz), 1.5, segments=12)
    return prism(outline - slot((-22.0, 0.0), (10.0, 0.0), 5.0), "x", start, end)


def _ear_outline() -> CrossSection:
    """Return a round end, a waist and a shoulder as wide as the cup."""
    end = circle((EAR_Y, 0.0), EAR_RADIUS, segments=36)
    waist = circle((-6.0, 0.0), 11.0)
    shoulder = rectangle((18.0, -EAR_HALF_WIDTH), (TOP, EAR_HALF_WIDTH))
    return CrossSection.batch_hull([end, waist]) + CrossSection.batch_hull([waist, shoulder])


def _cup() -> Manifold:
    half = EAR_HALF_WIDTH - STEP
    block = box((LEFT + STEP, PLATE_LOWER, -half), (RIGHT - STEP, TOP - STEP, half))
    servo = box((SERVO_LEFT, PLATE_UPPER, -20.0), (SERVO_RIGHT, TOP + 1, 20.0))
    cable_hole = cylinder("y", (0.0, -3.4), 6.0, PLATE_LOWER - 1, PLATE_UPPER + 1)
    return block - servo - cable_hole
