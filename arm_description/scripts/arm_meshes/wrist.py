"""The wrist: an upside-down U whose ears hang on a servo's horn and whose top carries another."""

from manifold3d import CrossSection, Manifold

from arm_meshes.outline import circle, rectangle
from arm_meshes.part import Part, Piece, box_around, box_between
from arm_meshes.solid import bevelled_box, cylinder, prism, union

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
SERVO_LOWER = (-12.25, -24.55)
SERVO_UPPER = (19.85, 25.55)


def wrist() -> Part:
    """Return the link wrist."""
    left, right = _ear(LEFT, LEFT_INNER, hole=5.0), _ear(RIGHT_INNER, RIGHT, hole=4.0)
    boss = cylinder("x", EAR_AXIS, 8.0, BOSS_INNER, RIGHT) - _axle_hole()
    plate = _plate()
    body = union([left, right, boss, plate, *_lugs()])
    collisions = (
        box_around(left),
        box_around(right),
        box_between((LEFT, FRONT, PLATE_UNDERSIDE), (RIGHT, BACK, PLATE_TOP)),
    )
    return Part("wrist", (Piece("wrist", "red", body),), collisions, body)


def _axle_hole() -> Manifold:
    return cylinder("x", EAR_AXIS, 4.0, BOSS_INNER - 1, RIGHT + 1)


def _ear(start: float, end: float, hole: float) -> Manifold:
    """Return an ear: an outline in (y, z), round below, as wide as the plate above."""
    y, z = EAR_AXIS
    end_circle = circle(EAR_AXIS, EAR_RADIUS, segments=36)
    shoulder = rectangle((FRONT, PLATE_UNDERSIDE), (10.0, PLATE_TOP))
    outline = CrossSection.batch_hull([end_circle, shoulder]) - circle(EAR_AXIS, hole)
    for dy, dz in ((8.0, 0.0), (0.0, 8.0), (-8.0, 0.0), (0.0, -8.0)):
        outline -= circle((y + dy, z + dz), 1.5, segments=12)
    return prism(outline, "x", start, end)


def _plate() -> Manifold:
    outline = rectangle((LEFT, FRONT), (RIGHT, BACK), corner=3.0)
    window = rectangle((-7.4, -21.5), (15.0, 1.0), corner=1.5)
    return prism(outline - window, "z", PLATE_UNDERSIDE, PLATE_TOP)


def _lugs() -> list[Manifold]:
    """Return the low walls that hold the servo on the plate."""
    x0, y0 = SERVO_LOWER
    x1, y1 = SERVO_UPPER
    bottom = PLATE_TOP - 1.0
    return [
        bevelled_box((x0, FRONT, bottom), (x1, y0, LUG_TOP), bevel=0.5),
        bevelled_box((x0, y1, bottom), (x1, BACK, LUG_TOP), bevel=0.5),
        bevelled_box((x0 - 4.0, -10.0, bottom), (x0, 10.0, LUG_TOP), bevel=0.5),
        bevelled_box((x1, -10.0, bottom), (x1 + 4.0, 10.0, LUG_TOP), bevel=0.5),
    ]
