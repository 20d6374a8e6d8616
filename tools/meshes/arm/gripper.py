"""The gripper: a plate with two arms on the last servo, and a scoop-shaped finger for each arm."""

from manifold3d import Manifold

from meshes.part import Part, Piece, board_between, box_between
from meshes.solid import Point, box, polygon, prism, rectangle, slot, union

PLATE_LOWER = (-21.0, -23.99)
PLATE_UPPER = (21.0, 33.81)
PLATE_UNDERSIDE, PLATE_TOP = -2.0, 3.0
ARM_REACH = 52.2
ARM_Y = 15.0
ARM_HALF_WIDTH = 9.0
WINDOW_HALF_WIDTH = 12.0
"""The servo's horn stands in the window, at y = ARM_Y."""

INNER = -14.16
"""The finger's open side, which faces the other finger (z in its link; x points forwards)."""
HEEL: Point = (-4.0, 26.66)
TIP = 48.2
TIP_Z = -10.0
FLOOR = -7.0
"""The scoop stands on the plate: the plate's top in the finger's x."""
HALF_WIDTH = 15.6
WALL = 2.4
BEVEL = 1.2
SLOT_XS = (8.0, 19.0, 30.0)
CLAMP_LOWER = (-14.7, -11.5, -5.5)
CLAMP_UPPER = (FLOOR, 11.5, 24.0)
GAP = 0.05


def gripper_plate() -> Part:
    """Return the link crawer_base."""
    middle = rectangle(PLATE_LOWER, PLATE_UPPER, corner=6.0)
    arms = rectangle(
        (-ARM_REACH, ARM_Y - ARM_HALF_WIDTH), (ARM_REACH, ARM_Y + ARM_HALF_WIDTH), corner=4.0
    )
    window = rectangle(
        (-WINDOW_HALF_WIDTH, ARM_Y - WINDOW_HALF_WIDTH),
        (WINDOW_HALF_WIDTH, ARM_Y + WINDOW_HALF_WIDTH),
        corner=1.5,
    )
    body = prism(middle + arms - window, "z", PLATE_UNDERSIDE, PLATE_TOP)
    collisions = (
        box_between((*PLATE_LOWER, PLATE_UNDERSIDE), (*PLATE_UPPER, PLATE_TOP)),
        box_between(
            (-ARM_REACH, ARM_Y - ARM_HALF_WIDTH, PLATE_UNDERSIDE),
            (ARM_REACH, ARM_Y + ARM_HALF_WIDTH, PLATE_TOP),
        ),
    )
    return Part("the_crawer_base", (Piece("the_crawer_base", "red", body),), collisions, body)


def finger() -> Part:
    """Return the links crawer_left and crawer_right."""
    body = _scoop() + _clamp()
    clamp_and_floor = box_between(
        (CLAMP_LOWER[0], -HALF_WIDTH, CLAMP_LOWER[2]), (HEEL[0], HALF_WIDTH, HEEL[1])
    )
    collisions = [clamp_and_floor, board_between(HEEL, (TIP, TIP_Z), WALL, 2 * HALF_WIDTH)]
    for y0, y1 in ((-HALF_WIDTH, WALL - HALF_WIDTH), (HALF_WIDTH - WALL, HALF_WIDTH)):
        collisions.append(box_between((HEEL[0], y0, INNER), (16.0, y1, 9.0)))
        collisions.append(box_between((16.0, y0, INNER), (TIP, y1, -6.0)))
    return Part("the_crawer", (Piece("the_crawer", "light", body),), tuple(collisions), body)


def _scoop() -> Manifold:
    """Return a wedge, a right triangle from the side, hollow and open on its inner side."""
    inside: list[Point] = [
        (INNER - 1, HEEL[0]),
        (HEEL[1] - 6.0, HEEL[0]),
        (TIP_Z - 2.5, TIP - 5.0),
        (INNER - 1, TIP - 5.0),
    ]
    hollow = prism(polygon(inside), "y", WALL - HALF_WIDTH, HALF_WIDTH - WALL)
    return _wedge() - hollow - union(_slope_slot(x) for x in SLOT_XS)


def _wedge() -> Manifold:
    """Return the scoop's outside: its outer edges are cut, the open side's are sharp."""
    outside: list[Point] = [
        (INNER, FLOOR),
        (HEEL[1], FLOOR),
        (HEEL[1], HEEL[0]),
        (TIP_Z, TIP),
        (INNER, TIP),
    ]
    inset: list[Point] = [
        (INNER, FLOOR + BEVEL),
        (HEEL[1] - BEVEL, FLOOR + BEVEL),
        (HEEL[1] - BEVEL, HEEL[0] - BEVEL / 2),
        (TIP_Z - BEVEL, TIP - BEVEL),
        (INNER, TIP - BEVEL),
    ]
    return Manifold.batch_hull(
        [
            prism(polygon(outside), "y", BEVEL - HALF_WIDTH, HALF_WIDTH - BEVEL),
            prism(polygon(inset), "y", -HALF_WIDTH, HALF_WIDTH),
        ]
    )


def _slope_slot(x: float) -> Manifold:
    """Return a cut through the sloping wall: it is only there that the scoop is not open."""
    return prism(slot((x, -7.0), (x, 7.0), radius=2.2), "z", TIP_Z, HEEL[1] + 1)


def _clamp() -> Manifold:
    """Return the block below the scoop that one of the plate's arms sticks in."""
    arm = box(
        (PLATE_UNDERSIDE - 10.0 - GAP, -ARM_HALF_WIDTH - GAP, CLAMP_LOWER[2] - 1),
        (PLATE_TOP - 10.0 + GAP, ARM_HALF_WIDTH + GAP, CLAMP_UPPER[2] + 1),
    )
    return box(CLAMP_LOWER, CLAMP_UPPER) - arm
