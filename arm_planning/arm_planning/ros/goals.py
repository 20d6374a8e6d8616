"""What the actions have in common: their servers, turns, feedback, ends and cancelling."""

import logging
import threading
import time
from collections import deque
from collections.abc import Callable
from typing import Any

from rclpy._rclpy_pybind11 import RCLError
from rclpy.action.server import ActionServer, CancelResponse, GoalResponse, ServerGoalHandle
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.node import Node

from arm_node.qos import SERVICE_QOS
from arm_planning.errors import MoveItErrorCode
from arm_planning.ros.answering import fill_error, report_fault
from arm_planning.ros.trajectory_executor import STOPPED, ExecutionOutcome

RESULT_TIMEOUT_S = 60
"""How long a result is kept for its client; rclpy's 15 minutes would fill the memory."""
CANCEL_TIMEOUT_S = 1.0
"""How long rclpy may take from the wish to cancel to the goal's status."""
CANCELLED = ExecutionOutcome(MoveItErrorCode.PREEMPTED, "the request was cancelled")
LOGGER = logging.getLogger("move_group")


class ServedGoal:
    """A goal while it is served.

    Attributes:
        request: the goal's message.
        has_moved: whether the robot has moved for it.
        is_cancelled: whether its client has cancelled it.
    """

    def __init__(self, handle: ServerGoalHandle, feedback: type[Any]) -> None:
        self.handle = handle
        self.request: Any = handle.request
        self.has_moved = False
        self._feedback = feedback
        self._interrupted = threading.Event()
        self.is_cancelled = False

    def begin(self) -> None:
        """Let the executor serve it."""
        try:
            self.handle.execute()
        except RCLError:
            # Its cancelling came in between, after which it can begin all the same, only to end.
            self.handle.execute()

    def say(self, state: str) -> None:
        """Publish a state as feedback: PLANNING, MONITOR, IDLE."""
        self.handle.publish_feedback(self._feedback(state=state))

    def cancel(self) -> None:
        """Note that its client wants it to end."""
        self.is_cancelled = True
        self._interrupted.set()

    def stop(self) -> None:
        """Note that the robot is to stop, whoever wants it."""
        self._interrupted.set()

    def is_interrupted(self) -> bool:
        """Return whether it is to end early. Any thread."""
        return self._interrupted.is_set()

    def ending(self, outcome: ExecutionOutcome) -> ExecutionOutcome:
        """Return how it ends: early if it is interrupted, whatever the outcome would be."""
        if not self.is_interrupted() or outcome.code is MoveItErrorCode.PREEMPTED:
            return outcome
        return CANCELLED if self.is_cancelled else STOPPED

    def wait(self, duration_s: float) -> None:
        """Wait, but no longer than until it is to end early."""
        # The duration is a client's: NaN and negative ones wait for nothing.
        if duration_s > 0.0:
            self._interrupted.wait(min(duration_s, threading.TIMEOUT_MAX))


class Turns:
    """Lets so many goals run at a time. Those that wait hold no thread of the executor."""

    def __init__(self, most: int = 1) -> None:
        self._most = most
        self._lock = threading.Lock()
        self._waiting: deque[ServedGoal] = deque()
        self._running: list[ServedGoal] = []

    def take(self, goal: ServedGoal) -> None:
        """Begin a goal, or let it wait for its turn."""
        with self._lock:
            if not goal.is_interrupted():
                if len(self._running) >= self._most:
                    self._waiting.append(goal)
                    return
                self._running.append(goal)
        goal.begin()

    def cancel(self, goal: ServedGoal) -> None:
        """Interrupt a goal; one that waits begins at once, only to end."""
        goal.cancel()
        with self._lock:
            if goal not in self._waiting:
                return
            self._waiting.remove(goal)
        goal.begin()

    def end(self, goal: ServedGoal) -> None:
        """Begin the next goal if the turn was this one's."""
        with self._lock:
            if goal not in self._running:
                return
            self._running.remove(goal)
            if not self._waiting:
                return
            following = self._waiting.popleft()
            self._running.append(following)
        following.begin()

    def stop(self) -> None:
        """Interrupt the goals whose turn it is."""
        with self._lock:
            running = list(self._running)
        for goal in running:
            goal.stop()


class GoalServer:
    """Serves an action: it takes every goal and every wish to cancel one, and always answers."""

    def __init__(
        self,
        node: Node,
        action: type[Any],
        name: str,
        serve: Callable[[ServedGoal, Any], ExecutionOutcome],
        turns: Callable[[Any], Turns],
    ) -> None:
        """Offer the action; several threads must spin the node.

        `serve` fills the result and returns the outcome; an exception of it becomes FAILURE.
        `turns` returns whose turns a goal's message takes.
        """
        self._action = action
        self._name = name
        self._serve = serve
        self._turns = turns
        self._goals: dict[bytes, ServedGoal] = {}
        self._lock = threading.Lock()
        self._server = ActionServer(
            node,
            action,
            name,
            self._execute,
            callback_group=ReentrantCallbackGroup(),
            goal_callback=lambda _: GoalResponse.ACCEPT,
            cancel_callback=self._cancel,
            handle_accepted_callback=self._begin,
            goal_service_qos_profile=SERVICE_QOS,
            result_service_qos_profile=SERVICE_QOS,
            cancel_service_qos_profile=SERVICE_QOS,
            result_timeout=RESULT_TIMEOUT_S,
        )

    def _goal(self, handle: ServerGoalHandle) -> ServedGoal:
        """Return what is known of a goal; its cancelling may come before its beginning."""
        with self._lock:
            goal = ServedGoal(handle, self._action.Feedback)
            return self._goals.setdefault(_id(handle), goal)

    def _begin(self, handle: ServerGoalHandle) -> None:
        goal = self._goal(handle)
        self._turns(goal.request).take(goal)

    def _cancel(self, handle: ServerGoalHandle) -> CancelResponse:
        if not handle.is_active:
            return CancelResponse.REJECT
        goal = self._goal(handle)
        self._turns(goal.request).cancel(goal)
        return CancelResponse.ACCEPT

    def _execute(self, handle: ServerGoalHandle) -> Any:
        goal = self._goal(handle)
        try:
            return self._result(goal)
        finally:
            with self._lock:
                del self._goals[_id(handle)]
            self._turns(goal.request).end(goal)

    def _result(self, goal: ServedGoal) -> Any:
        result = self._action.Result()
        try:
            outcome = CANCELLED if goal.is_cancelled else self._serve(goal, result)
        except Exception as error:
            result = self._action.Result()
            outcome = ExecutionOutcome(MoveItErrorCode.FAILURE, report_fault(self._name, error))
        fill_error(result, outcome.code, outcome.message)
        _finish(goal, outcome)
        goal.say("IDLE")
        return result


def _id(handle: ServerGoalHandle) -> bytes:
    return bytes(handle.goal_id.uuid)


def _finish(goal: ServedGoal, outcome: ExecutionOutcome) -> None:
    """Give a goal its status: succeeded, canceled or aborted; log the reason of a failure."""
    if outcome.code is MoveItErrorCode.SUCCESS:
        goal.handle.succeed()
        return
    LOGGER.error("%s: %s", outcome.code.name, outcome.message)
    is_preempted = outcome.code is MoveItErrorCode.PREEMPTED
    if is_preempted and goal.is_cancelled and _is_canceling(goal.handle):
        goal.handle.canceled()
    else:
        goal.handle.abort()


def _is_canceling(handle: ServerGoalHandle) -> bool:
    """Wait until rclpy has noted the wish to cancel: it calls back before it changes the status."""
    deadline_s = time.monotonic() + CANCEL_TIMEOUT_S
    while not handle.is_cancel_requested:
        if time.monotonic() > deadline_s:
            return False
        time.sleep(0.001)
    return True
