"""The wrist: an upside-down U whose ears hang on a servo's horn and whose top carries another."""

from manifold3d import CrossSection, Manifold

from meshes.part import Part, Piece, box_around, box_between
from meshes.solid import bevelled_box, circle, cylinder, prism, rectangle, union

LEFT, RIGHT = -20.19, 28.02
LEFT_INNER, RIGHT_INNER = -18.15, 25.0
"""The horn is at the left ear; the right ear reaches the servo with a boss."""
BOSS_INNER = 22.15
FRONT, BACK = -27.34, 27.37
EAR_AXIS = (-13.0, -17.0)
"""Where j3 turns, in (y, z)."""
EAR_RADIUS = 14.35
PLATE_UNDERSIDE = 5.5
PLATE_TOP = 9.5
"""The next servo stands here."""
LUG_TOP = 11.5
STEP = 0.05
"""Faces that would lie in one plane are this far apart, so that the union stays closed."""
SERVO_LOWER = (-12.25, -24.55)
SERVO_UPPER = (19.85, 25.55)


def wrist() -> Part:
    """Return the link wrist."""
    left, right = _ear(LEFT, LEFT_INNER), _ear(RIGHT_INNER, RIGHT)
    boss = cylinder("x", EAR_AXIS, 8.0, BOSS_INNER, RIGHT - 1.0)
    axle_hole = cylinder("x", EAR_AXIS, 4.5, LEFT - 1, RIGHT + 1)
    body = union([left, right, boss, _plate(), *_lugs()]) - axle_hole
    collisions = (
        box_around(left),
        box_around(right),
        box_between((LEFT, FRONT, PLATE_UNDERSIDE), (RIGHT, BACK, PLATE_TOP)),
    )
    return Part("wrist", (Piece("wrist", "red", body),), collisions, body)


def _ear(start: float, end: float) -> Manifold:
    """Return an ear: an outline in (y, z), round below, as wide as the plate above."""
    y, z = EAR_AXIS
    end_circle = circle(EAR_AXIS, EAR_RADIUS, segments=36)
    shoulder = rectangle((FRONT + STEP, PLATE_UNDERSIDE), (10.0, PLATE_TOP - STEP))
    outline = CrossSection.batch_hull([end_circle, shoulder])
    for dy, dz in ((8.0, 0.0), (0.0, 8.0), (-8.0, 0.0), (0.0, -8.0)):
        outline -= circle((y + dy, z + dz), 1.5, segments=12)
    return prism(outline, "x", start, end)


def _plate() -> Manifold:
    outline = rectangle((LEFT + STEP, FRONT), (RIGHT - STEP, BACK), corner=3.0)
    window = rectangle((-7.4, -21.5), (15.0, 1.0), corner=1.5)
    return prism(outline - window, "z", PLATE_UNDERSIDE, PLATE_TOP)


def _lugs() -> list[Manifold]:
    """Return the low walls that hold the servo on the plate."""
    x0, y0 = SERVO_LOWER
    x1, y1 = SERVO_UPPER
    bottom = PLATE_TOP - 1.0
    return [
        bevelled_box((x0, FRONT + STEP, bottom), (x1, y0, LUG_TOP), bevel=0.5),
        bevelled_box((x0, y1, bottom), (x1, BACK - STEP, LUG_TOP), bevel=0.5),
        bevelled_box((x0 - 4.0, -10.0, bottom), (x0, 10.0, LUG_TOP), bevel=0.5),
        bevelled_box((x1, -10.0, bottom), (x1 + 4.0, 10.0, LUG_TOP), bevel=0.5),
    ]
