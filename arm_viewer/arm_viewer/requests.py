"""Requests from the page to the ROS thread: frozen data that any thread may put into the queue.

First those about the robots and what is shown, then about the run, its world, and motion planning.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING

from arm_node.rigid_transform import RigidTransform, Vector
from arm_viewer.calls.call import CallRequest
from arm_viewer.world.dropped_file import DroppedFile

if TYPE_CHECKING:
    # Imported at run time only where a move_group runs.
    from arm_planning.scene.objects import CollisionObject


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


@dataclass(frozen=True, slots=True)
class SetGoal:
    """Choose where a group is to go, in rad or m; joints without a position stay where they are."""

    namespace: str
    group: str
    positions: Mapping[str, float]


@dataclass(frozen=True, slots=True)
class DragTip:
    """Choose where the tip of a group is to go, in the frame of the robot's root link.

    While one drags, the nearest posture is wanted, and what it touches is shown. If it `avoids`,
    the robot may take any posture that touches nothing.
    """

    namespace: str
    group: str
    pose: RigidTransform
    avoids: bool = False


@dataclass(frozen=True, slots=True)
class JogTip:
    """Let the robot follow with its tip, as long as this is repeated.

    The pose is in the frame of the robot's root link. A new number of the user's drag chooses the
    type of commands again.
    """

    namespace: str
    pose: RigidTransform
    drag: int


@dataclass(frozen=True, slots=True)
class PlanMotion:
    """Plan to the goal, with fractions of the limits; if it `executes`, move at once."""

    namespace: str
    velocity: float
    acceleration: float
    executes: bool


@dataclass(frozen=True, slots=True)
class ExecutePlan:
    """Execute the latest plan of this page."""

    namespace: str


@dataclass(frozen=True, slots=True)
class StopMotion:
    """Stop planning and whatever motion the move_group executes."""

    namespace: str


@dataclass(frozen=True, slots=True)
class AddObject:
    """Add an object to the planning scene; it replaces one of the same name."""

    namespace: str
    object: "CollisionObject"


@dataclass(frozen=True, slots=True)
class RemoveObject:
    """Remove an object from the planning scene."""

    namespace: str
    name: str


RunRequest = SetPlaying | StepRun | SetSpeed | ResetRun | UseSnapshot
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
PlanningRequest = (
    SetGoal | DragTip | JogTip | PlanMotion | ExecutePlan | StopMotion | AddObject | RemoveObject
)
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
