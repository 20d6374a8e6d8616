"""How goals end, and why requests are refused."""

from dataclasses import dataclass
from enum import IntEnum

from arm_control.goal_outcome import Outcome


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

    outcome: Outcome
    code: ErrorCode
    message: str

    @classmethod
    def aborted(cls, code: ErrorCode, message: str) -> "GoalResult":
        """Say that the controller gave the goal up."""
        return cls(Outcome.ABORTED, code, message)


@dataclass(frozen=True, slots=True)
class Refusal:
    """Why a request is not taken: a code for programs, a sentence for people."""

    code: ErrorCode
    message: str

    def as_result(self) -> GoalResult:
        """Return the result of a goal that was accepted only to say why it is refused."""
        return GoalResult.aborted(self.code, self.message)


GOAL_REACHED = GoalResult(Outcome.SUCCEEDED, ErrorCode.SUCCESSFUL, "Goal successfully reached!")
CANCELED = GoalResult(Outcome.CANCELED, ErrorCode.SUCCESSFUL, "")
PREEMPTED = GoalResult.aborted(
    ErrorCode.INVALID_GOAL, "Current goal preempted by new incoming action."
)
REPLACED = GoalResult.aborted(
    ErrorCode.INVALID_GOAL, "Current goal preempted by a trajectory on the topic."
)
DEACTIVATED = GoalResult.aborted(
    ErrorCode.INVALID_GOAL, "Current goal cancelled during deactivate transition."
)
PATH_TOLERANCE_VIOLATED = GoalResult.aborted(
    ErrorCode.PATH_TOLERANCE_VIOLATED, "Aborted due to path tolerance violation"
)
NOT_RUNNING = Refusal(
    ErrorCode.INVALID_GOAL, "Can't accept new action goals. Controller is not running."
)


def too_late(late_s: float) -> GoalResult:
    """Return the result of a goal that is outside its tolerance long after its end."""
    return GoalResult.aborted(
        ErrorCode.GOAL_TOLERANCE_VIOLATED,
        f"Aborted due to goal_time_tolerance exceeding by {late_s:f} seconds",
    )
