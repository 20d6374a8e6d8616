"""The adaptive gripper's fingers: a lever that ends in a block with a soft pad.

Drawn for the left side, which is at -x; the right side is its mirror image.
"""

from arm_meshes.outline import circle, rectangle
from arm_meshes.part import Part, Piece, box_between
from arm_meshes.solid import box, cylinder, prism, union
from manifold3d import CrossSection

from mycobot_meshes.lever import BAR_AXLE, FINGER_KG, GEAR_AXLE
from mycobot_meshes.mirror import mirrored

BOTTOM, TOP = -18.5, 2.1
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
    body = prism(lever + neck + head, "z", BOTTOM, TOP) - slot
    body += union(cylinder("z", axle, 2.6, BOTTOM, TOP) for axle in ((0.0, 0.0), SECOND_AXLE))
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
    return part if side == "left" else mirrored(part)
