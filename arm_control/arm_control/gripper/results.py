"""How the goals of a gripper end."""

from dataclasses import dataclass

from arm_control.goal_outcome import Outcome


@dataclass(frozen=True, slots=True)
class GripperState:
    """The joint at the end of a goal.

    Attributes:
        position: in rad or m.
        velocity: in rad/s or m/s.
        effort: commanded, or the limit that was set where no effort is commanded; N m or N.
    """

    position: float
    velocity: float
    effort: float


@dataclass(frozen=True, slots=True)
class GripperResult:
    """How a goal ended.

    Attributes:
        outcome: the goal's last state.
        message: for the log; the action has no place for it.
        state: of the joint; None where the result is empty.
        stalled: whether the joint had stopped on its way.
        reached_goal: whether the joint was there.
    """

    outcome: Outcome
    message: str
    state: GripperState | None = None
    stalled: bool = False
    reached_goal: bool = False


CANCELED = GripperResult(Outcome.CANCELED, "Goal canceled: the gripper holds where it is.")
PREEMPTED = GripperResult(Outcome.CANCELED, "Goal canceled: a new goal takes its place.")
NOT_RUNNING = "Can't accept new action goals. Controller is not running."


def reached(state: GripperState) -> GripperResult:
    """Return the result of a goal that was met."""
    return GripperResult(Outcome.SUCCEEDED, "Successfully moved to goal.", state, reached_goal=True)


def stalled(state: GripperState, target: float, *, is_success: bool) -> GripperResult:
    """Return the result of a goal on the way to which the joint stopped."""
    outcome = Outcome.SUCCEEDED if is_success else Outcome.ABORTED
    message = (
        f"The gripper has stopped at {state.position:.4g} on its way to {target:.4g}: "
        f"goal {outcome.value} (allow_stalling is {str(is_success).lower()})"
    )
    return GripperResult(outcome, message, state, stalled=True)


def deactivated(state: GripperState) -> GripperResult:
    """Return the result of a goal that the end of the controller has ended."""
    return GripperResult(
        Outcome.ABORTED, "Current goal cancelled during deactivate transition.", state
    )
