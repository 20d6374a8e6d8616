"""Requests from the page to the ROS thread: frozen data that any thread may put into the queue."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from arm_node.rigid_transform import RigidTransform


@dataclass(frozen=True, slots=True)
class MoveJoints:
    """Command joints of a robot through their active controllers.

    Attributes:
        namespace: namespace of the robot, as in `Description.namespace`.
        positions: positions in rad or m, by joint.
    """

    namespace: str
    positions: dict[str, float]


@dataclass(frozen=True, slots=True)
class SwitchControllers:
    """Activate and deactivate controllers of one manager, all or none.

    Attributes:
        manager: absolute name of the manager's node.
        activate: names of inactive controllers.
        deactivate: names of active controllers.
    """

    manager: str
    activate: tuple[str, ...] = ()
    deactivate: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Configure:
    """Configure a controller that is only loaded.

    Attributes:
        manager: absolute name of the manager's node.
        controller: name of the controller.
    """

    manager: str
    controller: str


@dataclass(frozen=True, slots=True)
class MeasureRates:
    """Start or stop measuring the rates of all topics."""

    wanted: bool


@dataclass(frozen=True, slots=True)
class ShowPictures:
    """Subscribe to exactly these image topics."""

    topics: frozenset[str]


@dataclass(frozen=True, slots=True)
class Watch:
    """Collect messages at the full rate, or only now and then while no browser shows them."""

    wanted: bool


@dataclass(frozen=True, slots=True)
class SetGoal:
    """Choose where a group is to go.

    Attributes:
        namespace: namespace of the move_group.
        group: name of the group.
        positions: positions in rad or m, by joint; joints without one stay where they are.
    """

    namespace: str
    group: str
    positions: Mapping[str, float]


@dataclass(frozen=True, slots=True)
class DragTip:
    """Choose where the tip of a group is to go.

    Attributes:
        namespace: namespace of the move_group.
        group: name of the group.
        pose: pose of the group's tip in the frame of the robot's root link.
    """

    namespace: str
    group: str
    pose: RigidTransform


@dataclass(frozen=True, slots=True)
class PlanMotion:
    """Plan to the goal.

    Attributes:
        namespace: namespace of the move_group.
        velocity: fraction of the velocity limits.
        acceleration: fraction of the acceleration limits.
        executes: whether the robot moves as soon as there is a plan.
    """

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


PlanningRequest = SetGoal | DragTip | PlanMotion | ExecutePlan | StopMotion
Request = (
    Watch
    | ShowPictures
    | MoveJoints
    | SwitchControllers
    | Configure
    | MeasureRates
    | PlanningRequest
)
Send = Callable[[Request], None]
"""Passes a request to the ROS thread without blocking; any thread may call it."""
