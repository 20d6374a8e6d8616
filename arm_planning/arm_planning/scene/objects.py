"""Objects of the planning scene: in the world, or attached to a link."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from arm_node.rigid_transform import RigidTransform
from arm_planning.scene.shapes import Shape


@dataclass(frozen=True, slots=True)
class PlacedShape:
    """A shape and its pose in the frame of its object."""

    shape: Shape
    pose: RigidTransform = RigidTransform()


@dataclass(frozen=True, slots=True)
class CollisionObject:
    """An object in the world.

    Attributes:
        id: its name.
        pose: pose of its frame in the planning frame.
        shapes: what it consists of.
        subframes: named poses in its frame, addressed as "id/name".
        type: its database key and type, ("", "") if unknown.
    """

    id: str
    pose: RigidTransform
    shapes: tuple[PlacedShape, ...]
    subframes: Mapping[str, RigidTransform] = field(default_factory=dict)
    type: tuple[str, str] = ("", "")


@dataclass(frozen=True, slots=True)
class AttachedBody:
    """An object that moves with a link.

    Attributes:
        object: the object; its pose is in the frame of the link.
        link: the link it is attached to.
        touch_links: links and attached bodies that it may touch; the link itself always may.
    """

    object: CollisionObject
    link: str
    touch_links: frozenset[str] = frozenset()
