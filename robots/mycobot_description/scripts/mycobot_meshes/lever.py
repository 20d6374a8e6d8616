"""The adaptive gripper's levers: the geared one that is driven and the bars beside it.

Drawn for the left side, which is at -x; the right side is its mirror image.
"""

import math

from arm_meshes.outline import Point, circle, polygon
from arm_meshes.part import BoxCollision, Part, Piece
from arm_meshes.solid import cylinder, prism, union
from manifold3d import CrossSection

from mycobot_meshes.mirror import mirrored

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
    return part if side == "left" else mirrored(part)


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
    return part if side == "left" else mirrored(part)


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
