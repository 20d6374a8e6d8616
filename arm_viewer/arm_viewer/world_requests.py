"""Requests from the page to the world of a simulation."""

from dataclasses import dataclass

from arm_node.rigid_transform import RigidTransform, Vector
from arm_viewer.world.dropped_file import DroppedFile


@dataclass(frozen=True, slots=True)
class LookAtThing:
    """Follow the pose of a thing; an empty name follows none."""

    name: str


@dataclass(frozen=True, slots=True)
class AddThing:
    """Spawn a thing, as URDF or SDF, at a pose in the world."""

    name: str
    text: str
    pose: RigidTransform


@dataclass(frozen=True, slots=True)
class AddFile:
    """Check a file, and spawn it at a pose in the world."""

    file: DroppedFile
    pose: RigidTransform


@dataclass(frozen=True, slots=True)
class PlaceThing:
    """Put a thing at a pose in the world, at rest."""

    name: str
    pose: RigidTransform


@dataclass(frozen=True, slots=True)
class PushThing:
    """Give a thing a velocity in the world, in m/s."""

    name: str
    velocity: Vector


@dataclass(frozen=True, slots=True)
class RemoveThing:
    """Delete a thing."""

    name: str


@dataclass(frozen=True, slots=True)
class OpenWorld:
    """Replace the world around the robots; `uri` is one that the simulation lists."""

    uri: str


@dataclass(frozen=True, slots=True)
class SetGravity:
    """Set the gravity in the world, in m/s²."""

    gravity: Vector


@dataclass(frozen=True, slots=True)
class SetProperties:
    """Set mass or sliding friction of a thing; None leaves one as it is."""

    name: str
    mass_kg: float | None
    friction: float | None


WorldRequest = (
    LookAtThing
    | AddThing
    | AddFile
    | PlaceThing
    | PushThing
    | RemoveThing
    | OpenWorld
    | SetGravity
    | SetProperties
)
