"""The world of a simulation, as it describes itself: frozen data."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

from arm_node.rigid_transform import RigidTransform, Vector


@dataclass(frozen=True, slots=True)
class Thing:
    """A thing of the world; robots are none.

    Attributes:
        pose: in the world.
        speed: of its origin, in m/s.
        can_move: whether it moves, or stays where it was put.
    """

    pose: RigidTransform
    speed: float
    can_move: bool


@dataclass(frozen=True, slots=True)
class ThingProperties:
    """Physical properties of a thing.

    Attributes:
        name: the thing.
        mass_kg: None if it is fixed, or not known yet.
        friction: coefficient of sliding friction; None if nothing can touch it, or not known yet.
    """

    name: str = ""
    mass_kg: float | None = None
    friction: float | None = None

    def words(self) -> str:
        """Return what is known, "" for nothing."""
        mass = "" if self.mass_kg is None else f"{self.mass_kg:.4g} kg"
        friction = "" if self.friction is None else f"friction {self.friction:.4g}"
        return ", ".join(filter(None, (mass, friction)))


def gravity_words(gravity: Vector) -> str:
    """Return a gravity as its user writes it, with its unit."""
    return " ".join(f"{value:.4g}" for value in gravity) + " m/s²"


@dataclass(frozen=True, slots=True)
class WorldAnswer:
    """What became of the user's last request.

    Attributes:
        number: counts the answers.
        text: what the user is told.
        is_done: whether it was done.
    """

    number: int = 0
    text: str = ""
    is_done: bool = True


@dataclass(frozen=True, slots=True)
class WorldView:
    """What a simulation says about its world.

    Attributes:
        things: by name.
        worlds: URIs of the worlds that it can load, by name.
        world: name of the one that is loaded; empty if unknown.
        gravity: in m/s²; None if the simulation does not say.
        properties: of the thing that the user looks at.
        answer: what became of the last request.
    """

    things: Mapping[str, Thing] = field(default_factory=lambda: MappingProxyType({}))
    worlds: Mapping[str, str] = field(default_factory=lambda: MappingProxyType({}))
    world: str = ""
    gravity: Vector | None = None
    properties: ThingProperties = ThingProperties()
    answer: WorldAnswer = WorldAnswer()
