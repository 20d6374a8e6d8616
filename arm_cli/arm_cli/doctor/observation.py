"""What the doctor observes of a running simulation, in about a second."""

from collections.abc import Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True, slots=True)
class LoadedController:
    """A loaded controller and the command interfaces that it has claimed."""

    name: str
    state: str
    claimed: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class ObservedHardware:
    """A hardware component, its claimed command interfaces, and its state interfaces."""

    name: str
    state: str
    claimed: Mapping[str, bool] = field(default_factory=dict)
    states: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class ControlState:
    """The state of a controller manager; unless it `answered`, nothing else is known."""

    manager: str
    answered: bool = True
    controllers: tuple[LoadedController, ...] = ()
    hardware: tuple[ObservedHardware, ...] = ()

    @property
    def option(self) -> str:
        """The command-line option that selects this manager."""
        return "" if self.manager == "/controller_manager" else f" -c {self.manager}"


@dataclass(frozen=True, slots=True)
class ClockReading:
    """How far /clock advanced.

    Attributes:
        simulated_s: simulation time between the first and the last message.
        wall_s: wall time between their arrivals.
        wanted_factor: the requested real-time factor; 0 means as fast as possible, None unknown.
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
    """A topic for joint states, with the names of the nodes at its ends.

    `not_numbers` are the NaN values of the last message, as interfaces such as 'j0/position'.
    """

    name: str
    publishers: tuple[str, ...] = ()
    listeners: tuple[str, ...] = ()
    received: int = 0
    not_numbers: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class SetpointTopic:
    """A topic for set-points, with the names of the nodes at its ends.

    Its controller is empty if none is loaded. The last message was stamped `ahead_s` after the
    simulation time at its arrival, None without a stamp, and its motion takes `lasting_s` from
    there.
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
class GraphObservation:
    """The input of the checks of a running simulation.

    Attributes:
        managers: the controller managers.
        publishers: the names of the publishing nodes, by topic.
        descriptions: the robot description by topic, empty if none arrived.
        clock: the clock, None if nothing arrived on /clock.
        clock_readers: the names of the nodes that subscribe to /clock.
        joint_states: the topics for joint states.
        mismatches: endpoints that cannot exchange messages.
        commands: the topics for set-points.
        nodes: the full name of every node, with duplicates.
        stopped: the topics that say that an emergency stop is latched.
    """

    managers: tuple[ControlState, ...] = ()
    publishers: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    descriptions: Mapping[str, str] = field(default_factory=dict)
    clock: ClockReading | None = None
    clock_readers: tuple[str, ...] = ()
    joint_states: tuple[StateTopic, ...] = ()
    mismatches: tuple[Mismatch, ...] = ()
    commands: tuple[SetpointTopic, ...] = ()
    nodes: tuple[str, ...] = ()
    stopped: tuple[str, ...] = ()

    @property
    def is_empty(self) -> bool:
        """Whether there is nothing to check."""
        return not (self.managers or self.is_timed or self.descriptions)

    @property
    def is_timed(self) -> bool:
        """Whether a node publishes /clock or subscribes to it."""
        return bool(self.publishers.get("/clock") or self.clock_readers)
