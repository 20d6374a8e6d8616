"""A mecanum wheel: a hub between two discs, and a ring of barrels that lie askew."""

from typing import Literal

from arm_meshes.part import CylinderCollision, Part, Piece
from arm_meshes.solid import cylinder, union
from manifold3d import Manifold

End = Literal["front", "back"]
Side = Literal["left", "right"]

ROLLERS = 10
RADIUS = 32.3
ROLLER_RADIUS, ROLLER_END_RADIUS = 6.4, 4.2
ROLLER_LENGTH = 30.0
ROLLER_SEGMENTS = 10
HALF_WIDTH = 15.2
INNER_END = 20.0
"""How far the hub reaches towards the robot."""
DISC_RADIUS = 24.0
MASS_KG = 9.1
LYING = (1.570796327, 0.0, 0.0)


def wheel(end: End, side: Side) -> Part:
    """Return the link of a wheel, which turns about its y axis.

    Seen from above, the barrels on top of the four wheels point to the robot's middle.
    """
    hand = 1.0 if (end == "front") == (side == "left") else -1.0
    name = f"{end}_{side}_wheel"
    rollers = union(_roller(number, hand) for number in range(ROLLERS))
    # The barrels bulge; together they are round.
    rollers ^= cylinder("y", (0.0, 0.0), RADIUS, -HALF_WIDTH, HALF_WIDTH, 60)
    hub = _hub(-1.0 if side == "left" else 1.0)
    body = cylinder("y", (0.0, 0.0), RADIUS, -HALF_WIDTH, HALF_WIDTH)
    return Part(
        f"{name}_link",
        (Piece(f"{name}_rollers", "dark", rollers), Piece(f"{name}_hub", "steel", hub)),
        (CylinderCollision((0.0, 0.0, 0.0), 32.5, 30.4, LYING),),
        body,
        mass_kg=MASS_KG,
    )


def _hub(inwards: float) -> Manifold:
    """Return the hub; `inwards` is the sign of y towards the robot."""
    ends = sorted((-inwards * HALF_WIDTH, inwards * INNER_END))
    axle = cylinder("y", (0.0, 0.0), 10.0, ends[0], ends[1])
    drum = cylinder("y", (0.0, 0.0), 18.0, -HALF_WIDTH + 2.0, HALF_WIDTH - 2.0)
    discs = [
        cylinder("y", (0.0, 0.0), DISC_RADIUS, y, y + 1.6)
        for y in (-HALF_WIDTH + 0.4, HALF_WIDTH - 2.0)
    ]
    return union([axle, drum, *discs])


def _roller(number: int, hand: float) -> Manifold:
    """Return one barrel, the first one on top of the wheel."""
    half = ROLLER_LENGTH / 2
    slices = [
        cylinder("x", (0.0, 0.0), radius, x, x + 0.5, ROLLER_SEGMENTS)
        for x, radius in (
            (-half, ROLLER_END_RADIUS),
            (-half / 2, ROLLER_RADIUS - 0.5),
            (-0.25, ROLLER_RADIUS),
            (half / 2 - 0.5, ROLLER_RADIUS - 0.5),
            (half - 0.5, ROLLER_END_RADIUS),
        )
    ]
    barrel = Manifold.batch_hull(slices).rotate((0.0, 0.0, hand * 45.0))
    on_top = barrel.translate((0.0, 0.0, RADIUS - ROLLER_RADIUS + 0.4))
    return on_top.rotate((0.0, number * 360.0 / ROLLERS, 0.0))
