"""What touches what in a state of the robot."""

from dataclasses import dataclass
from enum import IntEnum

from arm_node.rigid_transform import Vector

TOUCHING_M = 5e-5
"""Depth below which a contact is called a touch."""


class BodyKind(IntEnum):
    """The kinds of bodies; the values of moveit_msgs/ContactInformation."""

    ROBOT_LINK = 0
    WORLD_OBJECT = 1
    ROBOT_ATTACHED = 2


@dataclass(frozen=True, slots=True)
class CollisionContact:
    """The deepest contact between two bodies.

    Attributes:
        first: name of a link or attached body.
        second: name of the other: a link, an attached body or an object in the world.
        first_kind: what `first` is.
        second_kind: what `second` is.
        depth_m: how deep they are in each other, in m; negative if they are apart.
        position: the contact's point in the planning frame.
        normal: unit vector in the planning frame from `first` to `second`.
    """

    first: str
    second: str
    first_kind: BodyKind
    second_kind: BodyKind
    depth_m: float
    position: Vector
    normal: Vector

    def __str__(self) -> str:
        """Return it as the end of a sentence: "gripper_base with box1, 3 mm deep"."""
        if self.depth_m < 0.0:
            state = f"{_millimetres(-self.depth_m)} apart"
        elif self.depth_m < TOUCHING_M:
            state = "touching"
        else:
            state = f"{_millimetres(self.depth_m)} deep"
        return f"{self.first} with {self.second}, {state}"


def _millimetres(length_m: float) -> str:
    length_mm = length_m * 1e3
    return f"{length_mm:.0f} mm" if length_mm >= 10.0 else f"{length_mm:.2g} mm"
