"""The world of a simulation, as it describes itself: frozen data."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

from arm_node.rigid_transform import RigidTransform


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
        answer: what became of the last request.
    """

    things: Mapping[str, Thing] = field(default_factory=lambda: MappingProxyType({}))
    worlds: Mapping[str, str] = field(default_factory=lambda: MappingProxyType({}))
    world: str = ""
    answer: WorldAnswer = WorldAnswer()
