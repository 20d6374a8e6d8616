"""Requests from the page to the ROS thread: frozen data that any thread may put into the queue."""

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum

from arm_viewer.calls.call import CallRequest
from arm_viewer.planning_requests import PlanningRequest
from arm_viewer.world_requests import WorldRequest


@dataclass(frozen=True, slots=True)
class MoveJoints:
    """Command joints of a robot, in rad or m, through their active controllers."""

    namespace: str
    positions: dict[str, float]


@dataclass(frozen=True, slots=True)
class SwitchControllers:
    """Activate and deactivate controllers of one manager, all or none."""

    manager: str
    activate: tuple[str, ...] = ()
    deactivate: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Configure:
    """Configure a controller that is only loaded."""

    manager: str
    controller: str


@dataclass(frozen=True, slots=True)
class MeasureRates:
    """Start or stop measuring the rates of all topics."""

    wanted: bool


@dataclass(frozen=True, slots=True)
class PlotCurves:
    """Collect the samples of exactly these curves, named as in `plots.field_paths`."""

    names: frozenset[str]


@dataclass(frozen=True, slots=True)
class ListNumbers:
    """Find out which numbers the messages of each topic have."""


@dataclass(frozen=True, slots=True)
class ShowPictures:
    """Subscribe to exactly these image topics."""

    topics: frozenset[str]


@dataclass(frozen=True, slots=True)
class ShowContacts:
    """Subscribe to contacts, or end that."""

    wanted: bool


@dataclass(frozen=True, slots=True)
class Watch:
    """Collect messages at the full rate, or only now and then while no browser shows them."""

    wanted: bool


@dataclass(frozen=True, slots=True)
class SetPlaying:
    """Let simulation time go on, or pause it."""

    playing: bool


@dataclass(frozen=True, slots=True)
class StepRun:
    """Advance a paused simulation by control periods."""

    count: int


@dataclass(frozen=True, slots=True)
class SetSpeed:
    """Set the wanted ratio of simulation time to wall time; 0 is as fast as possible."""

    factor: float


@dataclass(frozen=True, slots=True)
class ResetRun:
    """Return everything in the simulation to its start, the clock unless it is kept."""

    keeps_clock: bool


class SnapshotDeed(Enum):
    """What may be done with a snapshot of the simulation."""

    SAVE = "save"
    RESTORE = "restore"
    REMOVE = "remove"


@dataclass(frozen=True, slots=True)
class UseSnapshot:
    """Save, restore or remove a snapshot of the simulation by its name."""

    deed: SnapshotDeed
    name: str


@dataclass(frozen=True, slots=True)
class SetEmergencyStop:
    """Stop every robot at once, or release the stop."""

    engaged: bool


RunRequest = SetPlaying | StepRun | SetSpeed | ResetRun | UseSnapshot
Request = (
    Watch
    | ShowPictures
    | ShowContacts
    | PlotCurves
    | ListNumbers
    | CallRequest
    | MoveJoints
    | SwitchControllers
    | Configure
    | MeasureRates
    | PlanningRequest
    | RunRequest
    | SetEmergencyStop
    | WorldRequest
)
Send = Callable[[Request], None]
"""Passes a request to the ROS thread without blocking; any thread may call it."""
