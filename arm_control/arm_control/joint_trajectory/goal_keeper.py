"""The goal that is being followed, and the news of it."""

import logging

from arm_control.joint_trajectory.motion import RESOLUTION_S
from arm_control.joint_trajectory.requests import GoalRequest
from arm_control.joint_trajectory.results import GoalResult, Outcome
from arm_control.joint_trajectory.state import ControllerState, Feedback, TrajectorySink


class GoalKeeper:
    """Keeps at most one goal, and sees that its client hears of it. Loop thread only.

    Attributes:
        goal: the goal; None where there is none.
    """

    def __init__(
        self, sink: TrajectorySink | None, feedback_rate_hz: float, logger: logging.Logger
    ) -> None:
        self.goal: GoalRequest | None = None
        self._sink = sink
        self._feedback_interval_s = 1.0 / feedback_rate_hz
        self._feedback_wait_s = 0.0
        self._logger = logger

    def start(self, goal: GoalRequest) -> None:
        """Keep a goal; there must be no other."""
        self.goal = goal
        self._feedback_wait_s = 0.0

    def give_feedback(self, state: ControllerState, period_s: float) -> None:
        """Tell how the goal is getting on, if it is time for that.

        Intervals are of the controller's time and counted from the goal's start, so the rate is
        right however fast the simulation runs.
        """
        if self.goal is None or self._sink is None:
            return
        if self._feedback_wait_s > RESOLUTION_S:
            self._feedback_wait_s -= period_s
        if self._feedback_wait_s > RESOLUTION_S:
            return
        self._feedback_wait_s = max(self._feedback_wait_s + self._feedback_interval_s, 0.0)
        self._sink.publish_feedback(
            self.goal.id,
            Feedback(
                state.time_s,
                state.progress,
                state.reference.copy(),
                state.feedback.copy(),
                state.error.copy(),
            ),
        )

    def end(self, result: GoalResult, detail: str = "") -> None:
        """End the goal, if there is one.

        Args:
            result: how.
            detail: what the log says beside the result.
        """
        if self.goal is None:
            return
        goal, self.goal = self.goal, None
        level = logging.WARNING if result.outcome is Outcome.ABORTED else logging.INFO
        message = result.message or f"Goal {result.outcome.value}"
        self._logger.log(level, "%s", f"{message}: {detail}" if detail else message)
        if self._sink is not None:
            self._sink.finish_goal(goal.id, result)
