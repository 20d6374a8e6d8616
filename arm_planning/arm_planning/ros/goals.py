"""What the actions have in common: their servers, feedback, ends and cancelling."""

import logging
import threading
from collections import deque
from collections.abc import Callable
from typing import Any

from rclpy.action.server import ActionServer, CancelResponse, GoalResponse, ServerGoalHandle
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.node import Node

from arm_planning.errors import MoveItErrorCode
from arm_planning.ros.trajectory_executor import ExecutionManager, ExecutionOutcome, Watch

RESULT_TIMEOUT_S = 60
"""How long a result is kept for its client; rclpy's 15 minutes would fill the memory."""
DEFAULT_REPLANS = 5
"""Attempts of a goal that asks to replan and gives no number."""
CANCELLED = ExecutionOutcome(MoveItErrorCode.PREEMPTED, "the request was cancelled")
LOGGER = logging.getLogger("move_group")


def action_server(
    node: Node,
    action: type[Any],
    name: str,
    serve: Callable[[ServerGoalHandle], Any],
    group: ReentrantCallbackGroup,
    turns: "Turns | None" = None,
) -> ActionServer:
    """Offer an action that takes every goal and every wish to cancel it, each in its turn."""

    def serve_in_turn(goal: ServerGoalHandle) -> Any:
        try:
            return serve(goal)
        finally:
            if turns is not None:
                turns.end()

    return ActionServer(
        node,
        action,
        name,
        serve_in_turn,
        callback_group=group,
        goal_callback=lambda _: GoalResponse.ACCEPT,
        cancel_callback=lambda _: CancelResponse.ACCEPT,
        handle_accepted_callback=_begin if turns is None else turns.take,
        result_timeout=RESULT_TIMEOUT_S,
    )


def _begin(goal: ServerGoalHandle) -> None:
    goal.execute()


class Turns:
    """Lets goals begin one after the other. Those that wait hold no thread of the executor."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._waiting: deque[ServerGoalHandle] = deque()
        self._is_busy = False

    def take(self, goal: ServerGoalHandle) -> None:
        """Begin a goal, or let it wait for its turn."""
        with self._lock:
            if self._is_busy:
                self._waiting.append(goal)
                return
            self._is_busy = True
        goal.execute()

    def end(self) -> None:
        """Begin the next goal."""
        with self._lock:
            if not self._waiting:
                self._is_busy = False
                return
            goal = self._waiting.popleft()
        goal.execute()


class GoalFeedback:
    """Publishes the states of a goal: PLANNING, MONITOR, IDLE."""

    def __init__(self, goal: ServerGoalHandle, message: type[Any]) -> None:
        self._goal = goal
        self._message = message

    def say(self, state: str) -> None:
        """Publish a state."""
        self._goal.publish_feedback(self._message(state=state))


def cancellable(goal: ServerGoalHandle, executor: ExecutionManager, watch: Watch) -> Watch:
    """Return a watch that also stops the robot once the goal is to be cancelled."""

    def watching(elapsed_s: float) -> str:
        if goal.is_cancel_requested:
            executor.stop()
        return watch(elapsed_s)

    return watching


def finish(goal: ServerGoalHandle, outcome: ExecutionOutcome) -> None:
    """Give a goal its status: succeeded, canceled or aborted; log the reason of a failure."""
    if outcome.code is MoveItErrorCode.SUCCESS:
        if outcome.message:
            LOGGER.info("%s", outcome.message)
        goal.succeed()
        return
    LOGGER.error("%s: %s", outcome.code.name, outcome.message)
    if outcome.code is MoveItErrorCode.PREEMPTED and goal.is_cancel_requested:
        goal.canceled()
    else:
        goal.abort()
