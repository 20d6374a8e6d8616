"""Goals: their requests and results, the queue in which requests wait, and their tolerances."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from enum import IntEnum
from typing import Any

import numpy as np
from numpy.typing import NDArray

from arm_control.controllers.goals import (
    SIMULATION_RESET,
    SIMULATION_RESTORED,
    GoalOutcome,
    RequestQueue,
    ended_at_deactivation,
    refused_while_inactive,
)
from arm_control.controllers.joint_trajectory.profiles import (
    ACCELERATION,
    POSITION,
    QUANTITIES,
    VELOCITY,
    Array,
)
from arm_control.controllers.joint_trajectory.trajectory import Trajectory, TrajectoryRequest
from arm_control.controllers.loaned_interfaces import describe_unmeasured
from arm_control.errors import ArmControlError


@dataclass(frozen=True, slots=True)
class JointTolerance:
    """Allowed errors of one joint; 0 stands for the controller's tolerance, -1 for none."""

    name: str
    position: float = 0.0
    velocity: float = 0.0
    acceleration: float = 0.0


@dataclass(frozen=True, slots=True)
class GoalRequest:
    """A goal of the action.

    Attributes:
        id: identifies the goal; it is returned with the result.
        trajectory: the trajectory to execute.
        path_tolerance: tolerances during the motion.
        goal_tolerance: tolerances at the end.
        goal_time_tolerance_s: how late the goal may be reached; 0 for the controller's tolerance,
            -1 for any time.
    """

    id: Any
    trajectory: TrajectoryRequest
    path_tolerance: Sequence[JointTolerance] = ()
    goal_tolerance: Sequence[JointTolerance] = ()
    goal_time_tolerance_s: float = 0.0


class ErrorCode(IntEnum):
    """Numbered as in control_msgs/action/FollowJointTrajectory."""

    SUCCESSFUL = 0
    INVALID_GOAL = -1
    INVALID_JOINTS = -2
    OLD_HEADER_TIMESTAMP = -3
    PATH_TOLERANCE_VIOLATED = -4
    GOAL_TOLERANCE_VIOLATED = -5


@dataclass(frozen=True, slots=True)
class GoalResult:
    """How a goal ended."""

    outcome: GoalOutcome
    code: ErrorCode
    message: str

    @classmethod
    def aborted(cls, code: ErrorCode, message: str) -> "GoalResult":
        """Return the result of an aborted goal."""
        return cls(GoalOutcome.ABORTED, code, message)


@dataclass(frozen=True, slots=True)
class GoalRefusal:
    """Why a request is refused: a code for programs, a message for users."""

    code: ErrorCode
    message: str

    def as_result(self) -> GoalResult:
        """Return the result of a goal that was accepted only to report the reason."""
        return GoalResult.aborted(self.code, self.message)


GOAL_REACHED = GoalResult(GoalOutcome.SUCCEEDED, ErrorCode.SUCCESSFUL, "Goal successfully reached!")
CANCELED = GoalResult(GoalOutcome.CANCELED, ErrorCode.SUCCESSFUL, "")
PREEMPTED = GoalResult.aborted(
    ErrorCode.INVALID_GOAL, "Current goal preempted by new incoming action."
)
REPLACED = GoalResult.aborted(
    ErrorCode.INVALID_GOAL, "Current goal preempted by a trajectory on the topic."
)
RESET = GoalResult.aborted(ErrorCode.INVALID_GOAL, SIMULATION_RESET)
RESTORED = GoalResult.aborted(ErrorCode.INVALID_GOAL, SIMULATION_RESTORED)
PATH_TOLERANCE_VIOLATED = GoalResult.aborted(
    ErrorCode.PATH_TOLERANCE_VIOLATED, "Aborted due to path tolerance violation"
)


def deactivated(halted_by: str) -> GoalResult:
    """Return the result of a goal that ends with its controller."""
    return GoalResult.aborted(ErrorCode.INVALID_GOAL, ended_at_deactivation(halted_by))


def not_running(halted_by: str) -> GoalRefusal:
    """Return the refusal of a goal by a controller that does not run."""
    return GoalRefusal(ErrorCode.INVALID_GOAL, refused_while_inactive(halted_by))


def not_checkable(names: Sequence[str]) -> GoalResult:
    """Return the result of a goal whose joints have these unmeasured states at the end."""
    return GoalResult.aborted(
        ErrorCode.GOAL_TOLERANCE_VIOLATED,
        f"Aborted: {describe_unmeasured(names)}, so the goal cannot be checked",
    )


def stalled(joint: str, distance: float, unit: str) -> GoalResult:
    """Return the result of a goal one of whose joints rests short of the end."""
    return GoalResult.aborted(
        ErrorCode.GOAL_TOLERANCE_VIOLATED,
        f"Aborted: joint {joint} does not follow: it rests {distance:.4g} {unit} from the goal; "
        f"constraints.{joint}.goal allows a larger error",
    )


def too_late(late_s: float) -> GoalResult:
    """Return the result of a goal that was not reached within the goal time tolerance."""
    return GoalResult.aborted(
        ErrorCode.GOAL_TOLERANCE_VIOLATED,
        f"Aborted due to goal_time_tolerance exceeding by {late_s:f} seconds",
    )


@dataclass(frozen=True, slots=True)
class GoalStart:
    """A request to start a goal."""

    goal: GoalRequest
    trajectory: Trajectory


@dataclass(frozen=True, slots=True)
class GoalCancel:
    """A request to cancel a goal."""

    goal_id: object


@dataclass(frozen=True, slots=True)
class TrajectoryReplacement:
    """A request to start a trajectory without a goal."""

    trajectory: Trajectory


@dataclass(frozen=True, slots=True)
class Stop:
    """Come to rest."""


Request = GoalStart | GoalCancel | TrajectoryReplacement
Motion = GoalStart | TrajectoryReplacement | Stop
"""What begins as soon as every position is known."""


class Inbox(RequestQueue[Request]):
    """The controller's request queue, in which a stream of trajectories does not pile up."""

    def _append(self, request: Request) -> None:
        # A trajectory replaces another one directly before it.
        last = self._requests[-1] if self._requests else None
        if isinstance(request, TrajectoryReplacement) and isinstance(last, TrajectoryReplacement):
            self._requests.pop()
        super()._append(request)


CHECKED_ROWS = 3
"""Position, velocity and acceleration; there is no tolerance for efforts."""

DISABLED = -1.0
"""In a goal: no tolerance, regardless of the controller's."""


class ToleranceError(ArmControlError):
    """A goal's tolerance cannot be used; the message says which."""


@dataclass(frozen=True, slots=True)
class Bounds:
    """The largest allowed errors, as absolute values.

    Attributes:
        values: for position, velocity and acceleration, shape (3, n); infinite for no bound.
        is_any: whether there is any bound.
    """

    values: Array
    is_any: bool

    @classmethod
    def of(cls, tolerances: Array) -> "Bounds":
        """Make bounds from tolerances, shape (3, n), of which 0 or less means none."""
        values = np.where(tolerances > 0.0, tolerances, np.inf)
        return cls(values, bool(np.isfinite(values).any()))

    def hold(self, error: Array) -> bool:
        """Return whether errors, shape (k, n) with k <= 3, are within bounds; NaN never is."""
        return not self.is_any or not self._is_outside(error).any()

    def excess(self, error: Array, joints: Sequence[str]) -> str:
        """Return which error is out of bounds, as a message; there must be one."""
        row, joint = np.argwhere(self._is_outside(error))[0]
        return (
            f"{QUANTITIES[row]} error of joint {joints[joint]} is {error[row, joint]:f}, "
            f"tolerance {self.values[row, joint]:f}"
        )

    def _is_outside(self, error: Array) -> NDArray[np.bool_]:
        bounds = self.values[: len(error)]
        # Not `error > bounds`: a comparison with NaN is false, so NaN would pass.
        return np.isfinite(bounds) & ~(np.abs(error) <= bounds)


@dataclass(frozen=True, slots=True)
class Tolerances:
    """The tolerances that are checked while a trajectory is followed.

    Attributes:
        path: bounds along the path.
        goal: bounds at the end.
        goal_time_s: how late `goal` may be met; 0 for any time.
    """

    path: Bounds
    goal: Bounds
    goal_time_s: float

    @classmethod
    def of(
        cls, path: Array, goal: Array, stopped_velocity: float, goal_time_s: float
    ) -> "Tolerances":
        """Make tolerances from the controller's parameters.

        The tolerances of positions along the path and at the end have the shape (n,), that of
        velocities at the end holds for every joint. `goal_time_s` is how late the goal may be
        reached.
        """
        on_the_way, at_end = np.zeros((2, CHECKED_ROWS, len(path)))
        on_the_way[POSITION] = path
        at_end[POSITION] = goal
        at_end[VELOCITY] = stopped_velocity
        return cls(Bounds.of(on_the_way), Bounds.of(at_end), goal_time_s)

    def switched_off(self) -> "Tolerances":
        """Return tolerances of the same joints without any bound."""
        off = Bounds.of(np.zeros_like(self.path.values))
        return Tolerances(off, off, 0.0)

    def for_goal(self, goal: GoalRequest, joints: Sequence[str]) -> "Tolerances":
        """Return these tolerances, overridden by a goal's.

        Raises:
            ToleranceError: the goal has a negative tolerance other than -1, or names an unknown
                joint.
        """
        return replace(
            self,
            path=_overridden(self.path, goal.path_tolerance, joints),
            goal=_overridden(self.goal, goal.goal_tolerance, joints),
            goal_time_s=_resolve(
                self.goal_time_s, goal.goal_time_tolerance_s, 0.0, "goal_time_tolerance"
            ),
        )


def _overridden(
    bounds: Bounds, tolerances: Iterable[JointTolerance], joints: Sequence[str]
) -> Bounds:
    values = bounds.values.copy()
    for tolerance in tolerances:
        if tolerance.name not in joints:
            raise ToleranceError(
                f"there is no joint '{tolerance.name}'; the joints are {', '.join(joints)}"
            )
        column = joints.index(tolerance.name)
        for row, asked in (
            (POSITION, tolerance.position),
            (VELOCITY, tolerance.velocity),
            (ACCELERATION, tolerance.acceleration),
        ):
            what = f"the {QUANTITIES[row]} tolerance of joint '{tolerance.name}'"
            values[row, column] = _resolve(values[row, column], asked, np.inf, what)
    return Bounds(values, bool(np.isfinite(values).any()))


def _resolve(default: float, asked: float, off: float, what: str) -> float:
    if asked == 0.0:
        return default
    if asked > 0.0:
        return asked
    if asked == DISABLED:
        return off
    raise ToleranceError(
        f"{what} is {asked:f}; it may be positive, 0 for the default or -1 for none"
    )
