"""Requests from the page that concern motion planning: frozen data, as in `requests`."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from arm_node.rigid_transform import RigidTransform

if TYPE_CHECKING:
    # Imported at run time only where a move_group runs.
    from arm_planning.scene.objects import CollisionObject


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


PlanningRequest = (
    SetGoal | DragTip | JogTip | PlanMotion | ExecutePlan | StopMotion | AddObject | RemoveObject
)
