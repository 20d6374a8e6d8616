"""What the actions have in common: their servers, feedback, ends and cancelling."""

import logging
from collections.abc import Callable
from typing import Any

from rclpy.action.server import ActionServer, CancelResponse, GoalResponse, ServerGoalHandle
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.node import Node

from arm_planning.errors import ErrorCode
from arm_planning.ros.trajectory_executor import Outcome, TrajectoryExecutor, Watch

RESULT_TIMEOUT_S = 60
"""How long a result is kept for its client; rclpy's 15 minutes would fill the memory."""
DEFAULT_REPLANS = 5
"""Attempts of a goal that asks to replan and gives no number."""
CANCELLED = Outcome(ErrorCode.PREEMPTED, "the request was cancelled")
LOGGER = logging.getLogger("move_group")


def action_server(
    node: Node,
    action: type[Any],
    name: str,
    serve: Callable[[ServerGoalHandle], Any],
    group: ReentrantCallbackGroup,
) -> ActionServer:
    """Offer an action that takes every goal and every wish to cancel it."""
    return ActionServer(
        node,
        action,
        name,
        serve,
        callback_group=group,
        goal_callback=lambda _: GoalResponse.ACCEPT,
        cancel_callback=lambda _: CancelResponse.ACCEPT,
        result_timeout=RESULT_TIMEOUT_S,
    )


class Feedback:
    """Publishes the states of a goal: PLANNING, MONITOR, IDLE."""

    def __init__(self, goal: ServerGoalHandle, message: type[Any]) -> None:
        self._goal = goal
        self._message = message

    def say(self, state: str) -> None:
        """Publish a state."""
        self._goal.publish_feedback(self._message(state=state))


def cancellable(goal: ServerGoalHandle, executor: TrajectoryExecutor, watch: Watch) -> Watch:
    """Return a watch that also stops the robot once the goal is to be cancelled."""

    def watching(elapsed_s: float) -> str:
        if goal.is_cancel_requested:
            executor.stop()
        return watch(elapsed_s)

    return watching


def finish(goal: ServerGoalHandle, outcome: Outcome) -> None:
    """Give a goal its status: succeeded, canceled or aborted; log the reason of a failure."""
    if outcome.code is ErrorCode.SUCCESS:
        if outcome.message:
            LOGGER.info("%s", outcome.message)
        goal.succeed()
        return
    LOGGER.error("%s: %s", outcome.code.name, outcome.message)
    if outcome.code is ErrorCode.PREEMPTED and goal.is_cancel_requested:
        goal.canceled()
    else:
        goal.abort()
