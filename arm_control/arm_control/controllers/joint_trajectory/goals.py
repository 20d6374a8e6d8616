"""The clients' requests, not yet checked, and the results of goals."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from enum import IntEnum
from itertools import chain
from typing import Any, overload

import numpy as np
from numpy.typing import NDArray

from arm_control.controllers.goals import (
    SIMULATION_RESET,
    SIMULATION_RESTORED,
    GoalOutcome,
    ended_at_deactivation,
    refused_while_inactive,
)
from arm_control.controllers.loaned_interfaces import describe_unmeasured

Array = NDArray[np.float64]

FIELDS = ("positions", "velocities", "accelerations", "effort")
"""The sequences of a waypoint, in the order of a motion's rows."""


@dataclass(frozen=True, slots=True)
class TrajectoryPoint:
    """A waypoint; each sequence has one number per joint or is empty.

    Attributes:
        time_from_start_s: its time since the start of the trajectory.
        positions: rad or m.
        velocities: rad/s or m/s.
        accelerations: rad/s² or m/s².
        effort: N m or N.
    """

    time_from_start_s: float
    positions: Sequence[float] = ()
    velocities: Sequence[float] = ()
    accelerations: Sequence[float] = ()
    effort: Sequence[float] = ()


@dataclass(frozen=True, slots=True, eq=False)
class WayPoints(Sequence[TrajectoryPoint]):
    """Waypoints as arrays, of which NumPy processes a hundred thousand in some milliseconds.

    A Python loop over as many takes most of a second, in which every other thread waits for the
    interpreter. Immutable.

    Attributes:
        times_s: time of each point, shape (m,).
        sizes: how many numbers each point has in each field, shape (m, 4).
        numbers: for each field, the numbers of all points one after another.
    """

    times_s: Array
    sizes: NDArray[np.intp]
    numbers: Sequence[Array]
    _ends: NDArray[np.intp] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        # The sum of each column of `sizes` is the length of that field.
        object.__setattr__(self, "numbers", tuple(self.numbers))
        object.__setattr__(self, "_ends", np.cumsum(self.sizes, axis=0))

    @classmethod
    def of(cls, points: Iterable[TrajectoryPoint]) -> "WayPoints":
        """Return points as arrays."""
        if isinstance(points, WayPoints):
            return points
        points = list(points)
        fields = [[getattr(point, field) for point in points] for field in FIELDS]
        sizes = np.array([[len(values) for values in field] for field in fields], dtype=np.intp)
        return cls(
            np.array([point.time_from_start_s for point in points], dtype=np.float64),
            sizes.T.reshape(-1, len(FIELDS)),
            # The numbers of a message are `array.array`s; converting them one by one takes 30 times
            # longer.
            [np.fromiter(chain.from_iterable(field), np.float64) for field in fields],
        )

    def given(self, kind: int, columns: int) -> tuple[NDArray[np.intp], Array]:
        """Return which points have numbers in one of FIELDS, and these numbers, (k, columns).

        Each point must have `columns` numbers or none.
        """
        return np.flatnonzero(self.sizes[:, kind]), self.numbers[kind].reshape(-1, columns)

    def __len__(self) -> int:
        return len(self.times_s)

    @overload
    def __getitem__(self, index: int) -> TrajectoryPoint: ...

    @overload
    def __getitem__(self, index: slice) -> Sequence[TrajectoryPoint]: ...

    def __getitem__(self, index: int | slice) -> TrajectoryPoint | Sequence[TrajectoryPoint]:
        if isinstance(index, slice):
            return [self[i] for i in range(*index.indices(len(self)))]
        index = range(len(self))[index]
        ends, sizes = self._ends[index].tolist(), self.sizes[index].tolist()
        fields = [
            numbers[end - size : end].tolist()
            for numbers, end, size in zip(self.numbers, ends, sizes, strict=True)
        ]
        return TrajectoryPoint(float(self.times_s[index]), *fields)


@dataclass(frozen=True, slots=True)
class TrajectoryRequest:
    """A trajectory.

    Attributes:
        joint_names: the joints, in the order of the points' numbers.
        points: the waypoints in order of time; stored as `WayPoints`.
        stamp_s: start time; 0 starts at once.
    """

    joint_names: Sequence[str]
    points: Sequence[TrajectoryPoint]
    stamp_s: float = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "points", WayPoints.of(self.points))

    @property
    def way_points(self) -> WayPoints:
        """The points as arrays."""
        return WayPoints.of(self.points)


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
