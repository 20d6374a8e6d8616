"""The adaptive gripper's body: what the flange holds, with the servo and the levers' axles.

Its y axis points from the flange to the fingertips; the levers move below z = 2.
"""

from arm_meshes.outline import circle, polygon, rectangle
from arm_meshes.part import Part, Piece, box_between
from arm_meshes.solid import bevelled_box, box, cylinder, prism, union
from manifold3d import CrossSection, Manifold

from mycobot_meshes.lever import BAR_AXLE, GEAR_AXLE, LOWEST

BACK, FRONT = -32.3, 29.9
UNDERSIDE, TOP = -13.2, 37.7
HALF_WIDTH = 29.0
DECK = (2.3, 7.3)
"""The plate above the levers, along z."""
HEEL_FRONT = -10.5
"""The gears turn in front of it."""


def gripper_body() -> Part:
    """Return the link gripper_base."""
    heel = bevelled_box((-HALF_WIDTH, BACK, UNDERSIDE), (HALF_WIDTH, HEEL_FRONT, 12.0), bevel=2.0)
    deck = prism(_deck_outline(), "z", *DECK)
    servo = bevelled_box((-12.0, -26.0, DECK[1] - 1.0), (12.0, 14.0, TOP), bevel=1.5)
    groove = box((-13.0, -27.0, 27.0), (13.0, 15.0, 28.0)) - box(
        (-11.5, -25.5, 26.0), (11.5, 13.5, 29.0)
    )
    label = box((-8.0, -20.0, TOP - 0.6), (8.0, 8.0, TOP + 1.0))
    shell = heel + deck
    case = servo - groove - label
    axles = union(_axle(side * x, y) for side in (-1, 1) for x, y in (GEAR_AXLE, BAR_AXLE))
    pieces = (
        Piece("gripper_base", "white", shell),
        Piece("gripper_base_servo", "dark", case - shell),
        Piece("gripper_base_axles", "steel", axles),
    )
    collision = box_between((-32.5, -12.5, -12.5), (32.5, 12.5, 12.5))
    return Part("gripper_base", pieces, (collision,), shell + servo + axles, mass_kg=0.07)


def _deck_outline() -> CrossSection:
    wide = rectangle((-HALF_WIDTH, HEEL_FRONT - 2.0), (HALF_WIDTH, 8.0), corner=3.0)
    shoulders = polygon([(-HALF_WIDTH, 4.0), (HALF_WIDTH, 4.0), (13.0, 22.0), (-13.0, 22.0)])
    nose = CrossSection.batch_hull(
        [circle((side * 8.0, FRONT - 5.0), 5.0) for side in (-1, 1)]
        + [rectangle((-13.0, 10.0), (13.0, 20.0))]
    )
    return wide + shoulders + nose


def _axle(x: float, y: float) -> Manifold:
    head = cylinder("z", (x, y), 3.2, DECK[1] - 0.5, DECK[1] + 1.2)
    return cylinder("z", (x, y), 1.8, LOWEST, DECK[1]) + head
