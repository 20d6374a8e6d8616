"""An action whose goals a controller serves on the loop thread."""

import logging
import threading
from abc import ABC, abstractmethod
from typing import Any, Generic, TypeVar

from rclpy.action.server import (
    ActionServer,
    CancelResponse,
    GoalEvent,
    GoalResponse,
    ServerGoalHandle,
)

from arm_control.controllers.goals import GoalController, GoalEnd, GoalOutcome
from arm_control.controllers.ros_adapter import ControllerAdapter
from arm_control.loop.ros_executor_bridge import EXECUTOR_TIMEOUT_S, let_executor_answer
from arm_node.qos import SERVICE_QOS

RESULT_TIMEOUT_S = 10
"""How long a result is kept for its client. With rclpy's default of 15 minutes, a stream of goals
would fill the memory; this is rcl's default."""


ControllerT = TypeVar("ControllerT", bound=GoalController[Any])
ResultT = TypeVar("ResultT", bound=GoalEnd)


class ControllerAction(ABC, Generic[ControllerT, ResultT]):
    """Passes goals to the controller, and its results to their clients.

    Goals arrive on the executor's thread, of which there must be only one; results arrive on the
    loop thread. The loop serves each request immediately, so that goals are cancelled and preempted
    even while the simulation is paused.

    rclpy would run a callback as long as a goal lasts. Here that callback runs when the goal has
    ended, because a coroutine that waits keeps rclpy's event-driven executor busy.
    """

    def __init__(
        self, adapter: ControllerAdapter[ControllerT], action_type: type[Any], name: str
    ) -> None:
        """Offer the action on the adapter's node, which an executor spins by now."""
        self.controller = adapter.controller
        self._loop = adapter.loop
        self._executor = adapter.executor
        self._logger = logging.getLogger(self.controller.name)
        self._running: dict[bytes, ServerGoalHandle] = {}
        self._ending: set[bytes] = set()
        self._idle = threading.Event()
        self._idle.set()
        self._server = ActionServer(
            adapter.node,
            action_type,
            name,
            _refuse_to_execute,
            goal_callback=self._answer,
            handle_accepted_callback=self._start,
            cancel_callback=self._cancel,
            goal_service_qos_profile=SERVICE_QOS,
            result_service_qos_profile=SERVICE_QOS,
            cancel_service_qos_profile=SERVICE_QOS,
            result_timeout=RESULT_TIMEOUT_S,
        )

    @abstractmethod
    def accepts(self, goal: Any) -> bool:
        """Return whether to accept a goal; log the reason if not. Executor's thread."""

    @abstractmethod
    def submit(self, goal_id: bytes, goal: Any) -> ResultT | None:
        """Start an accepted goal; return its result if it ended immediately.

        Executor's thread.
        """

    @abstractmethod
    def result_message(self, result: ResultT) -> Any:
        """Return the result message for the client. Executor's thread."""

    def wait_for_results(self) -> None:
        """Wait until the results of all goals have been sent; a control-plane thread."""
        self._idle.wait(EXECUTOR_TIMEOUT_S)
        let_executor_answer(self._executor)

    # Loop thread

    def handle_of(self, goal_id: bytes) -> ServerGoalHandle | None:
        """Return the handle of a goal; None if its client has already received a result.

        The goal of a restored snapshot has none either.
        """
        return self._running.get(goal_id)

    def finish(self, goal_id: bytes, result: ResultT) -> None:
        """End a goal, unless its client has already received a result; any thread."""
        if goal_id in self._running and goal_id not in self._ending:
            self._ending.add(goal_id)
            self._executor.create_task(self._end, goal_id, result)

    # Executor's thread

    def destroy(self) -> None:
        """Withdraw the action."""
        self._server.destroy()

    def _answer(self, goal: Any) -> GoalResponse:
        self._logger.info("Received new action goal")
        if not self.accepts(goal):
            return GoalResponse.REJECT
        if self._loop.lock_step is not None:
            # rclpy tells the client before it calls `_start`. A partner may then answer the period,
            # and the next one would begin with or without the goal.
            self._loop.lock_step.hold()
        return GoalResponse.ACCEPT

    def _start(self, handle: ServerGoalHandle) -> None:
        try:
            self._hand_over(handle)
        finally:
            if self._loop.lock_step is not None:
                self._loop.lock_step.release()
                self._loop.wake()

    def _hand_over(self, handle: ServerGoalHandle) -> None:
        goal_id = bytes(handle.goal_id.uuid)
        self._idle.clear()
        self._running[goal_id] = handle
        # `handle.execute` would also run the callback.
        handle._update_state(GoalEvent.EXECUTE)  # pyright: ignore[reportPrivateUsage]
        result = self.submit(goal_id, handle.request)
        if result is not None:
            self.finish(goal_id, result)
            return
        self._logger.info("Accepted new action goal")
        self._loop.call(self.controller.serve_requests)

    def _cancel(self, handle: ServerGoalHandle) -> CancelResponse:
        # The handle becomes canceling only after this returns. The goal cannot end earlier, because
        # its result is processed on this thread too.
        self._logger.info("Got request to cancel goal")
        self.controller.cancel_goal(bytes(handle.goal_id.uuid))
        self._loop.call(self.controller.serve_requests)
        return CancelResponse.ACCEPT

    def _end(self, goal_id: bytes, result: ResultT) -> None:
        # In this order: between the two, the loop's thread may finish the goal again.
        handle = self._running.pop(goal_id)
        self._ending.discard(goal_id)
        match result.outcome:
            case GoalOutcome.SUCCEEDED:
                handle.succeed()
            case GoalOutcome.ABORTED:
                handle.abort()
            case GoalOutcome.CANCELED:
                _cancel_by_itself(handle)
                handle.canceled()
        self._server.notify_execute(handle, lambda _: self.result_message(result))
        if not self._running:
            self._idle.set()


def _refuse_to_execute(_handle: ServerGoalHandle) -> None:
    """Never run: every goal gets its own callback when it ends."""
    raise AssertionError("a goal is executed before it has ended")


def _cancel_by_itself(handle: ServerGoalHandle) -> None:
    """Put a goal into 'canceling' although no client has requested it.

    A goal must pass through that state before it is canceled, and rclpy has no public method with
    which a server can enter it.
    """
    if not handle.is_cancel_requested:
        handle._update_state(GoalEvent.CANCEL_GOAL)  # pyright: ignore[reportPrivateUsage]
