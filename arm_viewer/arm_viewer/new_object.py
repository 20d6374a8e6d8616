"""An object that the user puts into the planning scene, from what the fields of the page hold."""

import math
from dataclasses import dataclass
from enum import Enum

from arm_description.transforms import quaternion_from_rpy
from arm_description.urdf.robot import Box, Cylinder, Sphere
from arm_node.rigid_transform import RigidTransform
from arm_planning.scene.objects import CollisionObject, PlacedShape


class ObjectKind(Enum):
    """The shapes that the page offers: name, lengths in m, and an example of them."""

    BOX = "box", ("x", "y", "z"), "0.05 0.05 0.05"
    SPHERE = "sphere", ("radius",), "0.03"
    CYLINDER = "cylinder", ("radius", "height"), "0.02 0.1"

    def __init__(self, word: str, lengths: tuple[str, ...], example: str) -> None:
        self.word = word
        self.lengths = lengths
        self.example = example


@dataclass(frozen=True, slots=True)
class ObjectFields:
    """What the user has entered, as it is.

    Attributes:
        name: name of the object.
        kind: its shape.
        size: the lengths of its kind, in m.
        position: of its centre in the planning frame, x y z in m.
        rpy: roll, pitch and yaw, in rad.
    """

    name: str
    kind: ObjectKind
    size: str
    position: str
    rpy: str


def new_object(fields: ObjectFields) -> CollisionObject:
    """Return the object.

    Raises:
        ValueError: it has no name, or a number cannot be used; the message is a sentence.
    """
    name = fields.name.strip()
    if not name:
        raise ValueError("The object needs a name.")
    x, y, z = _numbers("position", fields.position, ("x", "y", "z"))
    turns = _numbers("orientation", fields.rpy, ("roll", "pitch", "yaw"))
    i, j, k, w = quaternion_from_rpy(turns).tolist()
    pose = RigidTransform((x, y, z), (i, j, k, w))
    return CollisionObject(name, pose, (PlacedShape(_shape(fields)),))


def _shape(fields: ObjectFields) -> Box | Sphere | Cylinder:
    lengths = _numbers("size", fields.size, fields.kind.lengths)
    if min(lengths) <= 0.0:
        raise ValueError(f"The size must be greater than 0 m, not {min(lengths):g} m.")
    match fields.kind:
        case ObjectKind.BOX:
            x, y, z = lengths
            return Box((x, y, z))
        case ObjectKind.SPHERE:
            return Sphere(lengths[0])
        case ObjectKind.CYLINDER:
            return Cylinder(radius=lengths[0], length=lengths[1])


def _numbers(what: str, text: str, names: tuple[str, ...]) -> tuple[float, ...]:
    try:
        numbers = tuple(map(float, text.replace(",", " ").split()))
    except ValueError:
        numbers = ()
    if len(numbers) != len(names) or not all(map(math.isfinite, numbers)):
        raise ValueError(f"The {what} is not '{' '.join(names)}' in numbers: '{text}'")
    return numbers
