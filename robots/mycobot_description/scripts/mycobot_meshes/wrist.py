"""The wrist: link6, a T of two housings, and the flange that tools are screwed to."""

import math

from arm_meshes.part import CylinderCollision, Part, Piece
from arm_meshes.solid import cylinder, union

from mycobot_meshes.elbow import COLLAR, PROUD
from mycobot_meshes.housing import SEGMENTS, cap_disc, housing

RADIUS = 19.2
FRONT, BACK = 35.1, -21.6
"""Of the lying housing, along y: the flange is at the front."""
STEM_END = -38.0
STEM_RADIUS = 18.7
FLANGE_BACK, FLANGE_FACE = -12.0, 1.7
SCREW_CIRCLE = 14.5


def wrist() -> Part:
    """Return the link link6."""
    outside = union(
        [
            housing("y", (0.0, 0.0), RADIUS, FRONT, BACK, fillet=5.0),
            cylinder("z", (0.0, 0.0), STEM_RADIUS, STEM_END, 0.0, SEGMENTS),
        ]
    )
    room, disc = cap_disc("y", (0.0, 0.0), RADIUS - 4.0, BACK, inside=FRONT)
    standing, lying = (STEM_END - PROUD, STEM_END + COLLAR), (FRONT - COLLAR, FRONT + PROUD)
    collars = union(
        [
            cylinder("z", (0.0, 0.0), STEM_RADIUS + PROUD, *standing, SEGMENTS),
            cylinder("y", (0.0, 0.0), RADIUS + PROUD, *lying, SEGMENTS),
        ]
    )
    pieces = (
        Piece("link6", "white", outside - room - collars),
        Piece("link6_trim", "grey", collars + disc),
    )
    collision = CylinderCollision((0.0, 0.0, 0.0), 25.0, 60.0, (-math.pi / 2, 0.0, 0.0))
    return Part("link6", pieces, (collision,), outside, mass_kg=0.0739)


def flange() -> Part:
    """Return the link link6_flange."""
    disc = cylinder("z", (0.0, 0.0), RADIUS, FLANGE_BACK, FLANGE_FACE, SEGMENTS)
    holes = [cylinder("z", (0.0, 0.0), 6.0, FLANGE_FACE - 4.0, FLANGE_FACE + 1.0)]
    for quarter in range(4):
        angle = math.pi / 4 + quarter * math.pi / 2
        centre = (SCREW_CIRCLE * math.cos(angle), SCREW_CIRCLE * math.sin(angle))
        holes.append(cylinder("z", centre, 1.6, FLANGE_FACE - 6.0, FLANGE_FACE + 1.0, 12))
    body = disc - union(holes)
    collision = CylinderCollision((0.0, 0.0, 0.0), 20.0, 20.0)
    pieces = (Piece("link6_flange", "grey", body),)
    return Part("link6_flange", pieces, (collision,), body, mass_kg=0.035)
