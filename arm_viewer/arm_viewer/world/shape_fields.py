"""Shapes and numbers as the fields of the page hold them: texts that a user has typed."""

import math
from enum import Enum

from arm_description.transforms import quaternion_from_rpy
from arm_description.urdf.robot import Box, Cylinder, Sphere
from arm_node.rigid_transform import RigidTransform


class ObjectKind(Enum):
    """The shapes that the page offers: name, lengths in m, and an example of them."""

    BOX = "box", ("x", "y", "z"), "0.05 0.05 0.05"
    SPHERE = "sphere", ("radius",), "0.03"
    CYLINDER = "cylinder", ("radius", "height"), "0.02 0.1"

    def __init__(self, word: str, lengths: tuple[str, ...], example: str) -> None:
        self.word = word
        self.lengths = lengths
        self.example = example


KINDS = {kind.word: kind for kind in ObjectKind}
SIZE_HINT = "in m; " + "; ".join(f"{each.word}: {' '.join(each.lengths)}" for each in ObjectKind)


def read_shape(kind: ObjectKind, size: str) -> Box | Sphere | Cylinder:
    """Return the shape of a kind with these lengths in m.

    Raises:
        ValueError: they cannot be used; the message is a sentence.
    """
    lengths = read_numbers("size", size, kind.lengths)
    if min(lengths) <= 0.0:
        raise ValueError(f"The size must be greater than 0 m, not {min(lengths):g} m.")
    match kind:
        case ObjectKind.BOX:
            x, y, z = lengths
            return Box((x, y, z))
        case ObjectKind.SPHERE:
            return Sphere(lengths[0])
        case ObjectKind.CYLINDER:
            return Cylinder(radius=lengths[0], length=lengths[1])


def read_pose(position: str, rpy: str) -> RigidTransform:
    """Return the pose of "x y z" in m and "roll pitch yaw" in rad.

    Raises:
        ValueError: one of them cannot be used; the message is a sentence.
    """
    x, y, z = read_numbers("position", position, ("x", "y", "z"))
    turns = read_numbers("orientation", rpy, ("roll", "pitch", "yaw"))
    i, j, k, w = quaternion_from_rpy(turns).tolist()
    return RigidTransform((x, y, z), (i, j, k, w))


def read_number(what: str, text: str) -> float:
    """Return a finite number.

    Raises:
        ValueError: the text is none; the message is a sentence.
    """
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise ValueError(f"The {what} is not a number: '{text}'")
    return number


def read_numbers(what: str, text: str, names: tuple[str, ...]) -> tuple[float, ...]:
    """Return as many finite numbers as there are names.

    Raises:
        ValueError: the text does not have them; the message is a sentence.
    """
    try:
        numbers = tuple(map(float, text.replace(",", " ").split()))
    except ValueError:
        numbers = ()
    if len(numbers) != len(names) or not all(map(math.isfinite, numbers)):
        raise ValueError(f"The {what} is not '{' '.join(names)}' in numbers: '{text}'")
    return numbers
