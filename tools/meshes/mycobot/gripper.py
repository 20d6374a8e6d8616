"""The myCobot's adaptive gripper: body, levers and fingers.

The body's y axis points from the flange to the fingertips; the levers move below z = 2. Levers and
fingers are drawn for the left side, which is at -x; the right side is its mirror image.
"""

import math
from dataclasses import replace

from manifold3d import CrossSection, Manifold

from meshes.part import BoxCollision, Part, Piece, box_between
from meshes.solid import (
    Point,
    bevelled_box,
    box,
    circle,
    cylinder,
    polygon,
    prism,
    rectangle,
    union,
)

GEAR_AXLE: Point = (12.0, 5.0)
BAR_AXLE: Point = (5.0, 27.0)
"""Where the levers turn, in the frame of the gripper's body."""
REACH: Point = (-27.0, 16.0)
"""From a lever's axle to where it holds the finger."""
LOWEST = -18.2
UPPER_PLATE = (-3.2, 1.8)
LOWER_PLATE = (-18.2, -14.2)
ROOT_RADIUS, TIP_RADIUS = 10.4, 12.8
TEETH = 18
FINGER_KG = 0.007


def geared_lever(side: str) -> Part:
    """Return gripper_left3 or gripper_right3."""
    arm = CrossSection.batch_hull([circle((0.0, 0.0), 7.0), circle(REACH, 4.2)])
    outline = _gear() + arm - circle((0.0, 0.0), 1.9) - circle((-13.5, 8.0), 2.6)
    body = prism(outline, "z", *UPPER_PLATE)
    name = f"gripper_{side}3"
    # Where the left lever has it: small, beside the axle, on the fingers' side.
    collision = BoxCollision((-14.0, 5.0, 5.0), (10.0, 10.0, 10.0))
    part = Part(name, (Piece(name, "dark", body),), (collision,), body, FINGER_KG)
    return part if side == "left" else _mirrored(part)


def bars(side: str) -> Part:
    """Return gripper_left2 or gripper_right2: two bars, one above the other."""
    outline = CrossSection.batch_hull([circle((0.0, 0.0), 4.4), circle(REACH, 4.0)])
    outline = outline - circle((0.0, 0.0), 1.9)
    pin = cylinder("z", REACH, 1.8, LOWER_PLATE[0], UPPER_PLATE[1])
    plates = [prism(outline, "z", *LOWER_PLATE), prism(outline, "z", -2.2, 1.8)]
    body = union([*plates, pin])
    name = f"gripper_{side}2"
    collision = BoxCollision((-25.0, 0.0, -10.0), (20.0, 20.0, 20.0))
    part = Part(name, (Piece(name, "dark", body),), (collision,), body, FINGER_KG)
    return part if side == "left" else _mirrored(part)


def _gear() -> CrossSection:
    """Return a gear wheel whose teeth are trapezoids."""
    corners: list[Point] = []
    for tooth in range(TEETH):
        for offset, radius in ((0.0, ROOT_RADIUS), (0.3, TIP_RADIUS), (0.55, TIP_RADIUS)):
            angle = 2 * math.pi * (tooth + offset) / TEETH
            corners.append((radius * math.cos(angle), radius * math.sin(angle)))
        angle = 2 * math.pi * (tooth + 0.85) / TEETH
        corners.append((ROOT_RADIUS * math.cos(angle), ROOT_RADIUS * math.sin(angle)))
    return polygon(corners)


FINGER_BOTTOM, FINGER_TOP = -18.5, 2.1
TIP = 53.2
INNER = 19.5
"""Where the pad's face is: 19.5 mm from the middle with the gripper open."""
PAD = 3.0
PAD_LOWER, PAD_UPPER = 32.0, 52.0
SECOND_AXLE = (GEAR_AXLE[0] - BAR_AXLE[0], BAR_AXLE[1] - GEAR_AXLE[1])
"""Where the bars hold the finger: it keeps its direction, as the other side of a parallelogram."""


def finger(side: str) -> Part:
    """Return gripper_left1 or gripper_right1."""
    lever = CrossSection.batch_hull([circle((0.0, 0.0), 4.8), circle(SECOND_AXLE, 4.8)])
    neck = CrossSection.batch_hull([circle(SECOND_AXLE, 4.8), rectangle((8.0, 32.0), (14.0, 36.0))])
    head = rectangle((6.5, 31.0), (INNER - PAD, TIP), corner=2.5)
    slot = prism(rectangle((-10.0, -10.0), (25.0, 28.0)), "z", -13.9, -3.5)
    body = prism(lever + neck + head, "z", FINGER_BOTTOM, FINGER_TOP) - slot
    body += union(
        cylinder("z", axle, 2.6, FINGER_BOTTOM, FINGER_TOP) for axle in ((0.0, 0.0), SECOND_AXLE)
    )
    pad = box((INNER - PAD - 0.5, PAD_LOWER, -17.5), (INNER, PAD_UPPER, -2.5))
    grooves = [
        box((INNER - 0.8, y, -18.0), (INNER + 1.0, y + 1.0, -2.0)) for y in (36.0, 40.0, 44.0, 48.0)
    ]
    name = f"gripper_{side}1"
    pieces = (
        Piece(name, "white", body - pad),
        Piece(f"{name}_pad", "dark", pad - union(grooves)),
    )
    collision = box_between((6.5, PAD_LOWER, -17.5), (INNER, PAD_UPPER, -2.5))
    part = Part(name, pieces, (collision,), body + pad, FINGER_KG)
    return part if side == "left" else _mirrored(part)


BACK, FRONT = -32.3, 29.9
UNDERSIDE, SERVO_TOP = -13.2, 37.7
HALF_WIDTH = 29.0
DECK = (2.3, 7.3)
"""The plate above the levers, along z."""
HEEL_FRONT = -10.5
"""The gears turn in front of it."""


def gripper_body() -> Part:
    """Return the link gripper_base."""
    heel = bevelled_box((-HALF_WIDTH, BACK, UNDERSIDE), (HALF_WIDTH, HEEL_FRONT, 12.0), bevel=2.0)
    deck = prism(_deck_outline(), "z", *DECK)
    servo = bevelled_box((-12.0, -26.0, DECK[1] - 1.0), (12.0, 14.0, SERVO_TOP), bevel=1.5)
    groove = box((-13.0, -27.0, 27.0), (13.0, 15.0, 28.0)) - box(
        (-11.5, -25.5, 26.0), (11.5, 13.5, 29.0)
    )
    label = box((-8.0, -20.0, SERVO_TOP - 0.6), (8.0, 8.0, SERVO_TOP + 1.0))
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


def _mirrored(part: Part) -> Part:
    """Return a part with upright boxes for contacts as seen in a mirror at x = 0."""
    pieces = tuple(
        Piece(piece.mesh, piece.material, piece.solid.mirror((1.0, 0.0, 0.0)))
        for piece in part.pieces
    )
    boxes = [shape for shape in part.collisions if isinstance(shape, BoxCollision)]
    collisions = tuple(
        replace(shape, centre=(-shape.centre[0], *shape.centre[1:])) for shape in boxes
    )
    body = None if part.body is None else part.body.mirror((1.0, 0.0, 0.0))
    return replace(part, pieces=pieces, collisions=collisions, body=body)
