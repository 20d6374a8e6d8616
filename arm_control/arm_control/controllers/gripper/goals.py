"""The goals of a gripper controller: requests and results."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from arm_control.controllers.goals import (
    SIMULATION_RESET,
    SIMULATION_RESTORED,
    GoalOutcome,
    ended_at_deactivation,
)
from arm_control.controllers.loaned_interfaces import describe_unmeasured


@dataclass(frozen=True, slots=True)
class GripperRequest:
    """An action goal as received, not yet checked.

    Attributes:
        id: identifies the goal; it is returned with the result.
        positions: rad or m; must hold exactly one number.
        efforts: N m or N; the effort limit, or empty for the controller's default.
        velocities: rad/s or m/s; the velocity limit, or empty for the controller's default.
    """

    id: Any
    positions: Sequence[float]
    efforts: Sequence[float] = ()
    velocities: Sequence[float] = ()


@dataclass(frozen=True, slots=True)
class GripperTarget:
    """The set-point of the joint.

    Attributes:
        position: target position, in rad or m.
        max_effort: effort limit, in N m or N.
        max_velocity: velocity limit, in rad/s or m/s.
    """

    position: float
    max_effort: float
    max_velocity: float


@dataclass(frozen=True, slots=True)
class GripperCancel:
    """A request to cancel a goal."""

    goal_id: object


@dataclass(frozen=True, slots=True)
class GripperState:
    """The joint at the end of a goal.

    Attributes:
        position: in rad or m.
        velocity: in rad/s or m/s.
        effort: the commanded effort, or the effort limit if none is commanded; N m or N.
    """

    position: float
    velocity: float
    effort: float


@dataclass(frozen=True, slots=True)
class GripperResult:
    """How a goal ended.

    Attributes:
        outcome: the goal's last state.
        message: for the log; the action has no field for it.
        state: the joint's state; None for an empty result.
        stalled: whether the joint stopped before the goal.
        reached_goal: whether the joint reached the goal.
    """

    outcome: GoalOutcome
    message: str
    state: GripperState | None = None
    stalled: bool = False
    reached_goal: bool = False


CANCELED = GripperResult(GoalOutcome.CANCELED, "Goal canceled: the gripper holds where it is.")
RESET = GripperResult(GoalOutcome.ABORTED, SIMULATION_RESET)
RESTORED = GripperResult(GoalOutcome.ABORTED, SIMULATION_RESTORED)
PREEMPTED = GripperResult(GoalOutcome.CANCELED, "Goal canceled: a new goal takes its place.")


def reached(state: GripperState) -> GripperResult:
    """Return the result of a goal that was reached."""
    return GripperResult(
        GoalOutcome.SUCCEEDED, "Successfully moved to goal.", state, reached_goal=True
    )


def stalled(state: GripperState, target: float, *, is_success: bool) -> GripperResult:
    """Return the result of a goal whose joint stopped before reaching it."""
    outcome = GoalOutcome.SUCCEEDED if is_success else GoalOutcome.ABORTED
    message = (
        f"The gripper has stopped at {state.position:.4g} on its way to {target:.4g}: "
        f"goal {outcome.value} (allow_stalling is {str(is_success).lower()})"
    )
    return GripperResult(outcome, message, state, stalled=True)


def unmeasured(state: GripperState, names: Sequence[str]) -> GripperResult:
    """Return the result of a goal that cannot be checked: these states are not numbers."""
    message = f"Goal aborted: {describe_unmeasured(names)}, so the goal cannot be checked"
    return GripperResult(GoalOutcome.ABORTED, message, state)


def deactivated(state: GripperState, halted_by: str) -> GripperResult:
    """Return the result of a goal that ends with its controller."""
    return GripperResult(GoalOutcome.ABORTED, ended_at_deactivation(halted_by), state)
