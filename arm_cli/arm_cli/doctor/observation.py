"""What was seen of a running simulation, in a second or so."""

from collections.abc import Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True, slots=True)
class LoadedController:
    """A controller, with the command interfaces that it has claimed."""

    name: str
    state: str
    claimed: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class HardwareComponent:
    """A hardware component, with its command interfaces: whether each is claimed."""

    name: str
    state: str
    claimed: Mapping[str, bool] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class ControlState:
    """What a controller manager says.

    Attributes:
        manager: absolute name of its node.
        answered: False where it does not answer; nothing else is known then.
        controllers: all that are loaded.
        hardware: all components.
    """

    manager: str
    answered: bool = True
    controllers: tuple[LoadedController, ...] = ()
    hardware: tuple[HardwareComponent, ...] = ()

    @property
    def option(self) -> str:
        """What to add to a command line for this manager."""
        return "" if self.manager == "/controller_manager" else f" -c {self.manager}"


@dataclass(frozen=True, slots=True)
class ClockReading:
    """How far /clock went.

    Attributes:
        simulated_s: between the first and the last message.
        wall_s: between their arrivals.
        wanted_factor: simulated over wall time that was asked for, 0 for as fast as possible, None
            where that is not known.
    """

    simulated_s: float
    wall_s: float
    wanted_factor: float | None = None


@dataclass(frozen=True, slots=True)
class Mismatch:
    """A publisher and a subscription that never exchange a message, and why."""

    topic: str
    publisher: str
    subscription: str
    reason: str


@dataclass(frozen=True, slots=True)
class StateTopic:
    """A topic on which joint states come, or are waited for.

    Attributes:
        name: of the topic.
        publishers: names of the nodes that publish it.
        listeners: names of the nodes that listen to it.
        received: how many messages came.
    """

    name: str
    publishers: tuple[str, ...] = ()
    listeners: tuple[str, ...] = ()
    received: int = 0


@dataclass(frozen=True, slots=True)
class CommandTopic:
    """A topic on which set-points come.

    Attributes:
        name: of the topic.
        publishers: names of the nodes that publish it.
        listeners: names of the nodes that listen to it.
        controller: the controller that it belongs to, empty where none is loaded.
        state: of that controller.
        received: how many messages came.
        ahead_s: how far the last message's stamp was ahead of the simulation; None without a stamp.
        lasting_s: how long that message's motion takes from its stamp on.
    """

    name: str
    publishers: tuple[str, ...] = ()
    listeners: tuple[str, ...] = ()
    controller: str = ""
    state: str = ""
    received: int = 0
    ahead_s: float | None = None
    lasting_s: float = 0.0


@dataclass(frozen=True, slots=True)
class Observation:
    """All that the checks of a running simulation need.

    Attributes:
        managers: the controller managers.
        publishers: names of the publishing nodes, by topic.
        descriptions: the robot description that came on each such topic, empty where none came.
        clock: None where nothing came on /clock.
        clock_readers: names of the nodes that go by /clock.
        joint_states: topics with joint states.
        mismatches: end points that cannot talk to each other.
        commands: topics with set-points.
    """

    managers: tuple[ControlState, ...] = ()
    publishers: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    descriptions: Mapping[str, str] = field(default_factory=dict)
    clock: ClockReading | None = None
    clock_readers: tuple[str, ...] = ()
    joint_states: tuple[StateTopic, ...] = ()
    mismatches: tuple[Mismatch, ...] = ()
    commands: tuple[CommandTopic, ...] = ()

    @property
    def is_empty(self) -> bool:
        """Whether there is nothing to examine."""
        return not (self.managers or self.is_timed or self.descriptions)

    @property
    def is_timed(self) -> bool:
        """Whether somebody publishes /clock, or goes by it."""
        return bool(self.publishers.get("/clock") or self.clock_readers)
