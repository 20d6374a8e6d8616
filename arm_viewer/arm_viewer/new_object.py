"""An object that the user puts into the planning scene, from what the fields of the page hold."""

from dataclasses import dataclass

from arm_planning.scene.objects import CollisionObject, PlacedShape
from arm_viewer.world.shape_fields import ObjectKind, read_pose, read_shape


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
    pose = read_pose(fields.position, fields.rpy)
    return CollisionObject(name, pose, (PlacedShape(read_shape(fields.kind, fields.size)),))
