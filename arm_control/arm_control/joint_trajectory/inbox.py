"""What the control loop is asked for, on its way there."""

from dataclasses import dataclass

from arm_control.joint_trajectory.requests import GoalRequest
from arm_control.joint_trajectory.trajectory import Trajectory
from arm_control.request_queue import RequestQueue


@dataclass(frozen=True, slots=True)
class GoalStart:
    """A goal is to start."""

    goal: GoalRequest
    trajectory: Trajectory


@dataclass(frozen=True, slots=True)
class GoalCancel:
    """A goal is to end."""

    goal_id: object


@dataclass(frozen=True, slots=True)
class Replacement:
    """A trajectory without a goal is to start."""

    trajectory: Trajectory


Request = GoalStart | GoalCancel | Replacement


class Inbox(RequestQueue[Request]):
    """The controller's queue; a stream of trajectories does not pile up in it."""

    def _append(self, request: Request) -> None:
        # One trajectory takes the place of another right before it.
        last = self._requests[-1] if self._requests else None
        if isinstance(request, Replacement) and isinstance(last, Replacement):
            self._requests.pop()
        super()._append(request)
