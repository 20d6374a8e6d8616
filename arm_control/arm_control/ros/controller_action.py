"""An action whose goals a controller serves on the loop thread."""

import logging
import threading
from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any, Generic, Protocol, TypeVar, cast

from rclpy.action.server import (
    ActionServer,
    CancelResponse,
    GoalEvent,
    GoalResponse,
    ServerGoalHandle,
)
from rclpy.executors import Executor
from rclpy.node import Node
from rclpy.task import Future

from arm_control.control_loop import ControlLoop
from arm_control.goal_outcome import Outcome
from arm_control.ros.executor_bridge import EXECUTOR_TIMEOUT_S, let_executor_answer, settle

RESULT_TIMEOUT_S = 10
"""How long a result is kept for its client. With rclpy's quarter of an hour a stream of goals
would fill the memory; this is rcl's own figure."""


class GoalEnd(Protocol):
    """How a goal ended."""

    @property
    def outcome(self) -> Outcome:
        """The goal's last state."""
        ...


class GoalController(Protocol):
    """What a controller does with its goals; see `ControllerAction`."""

    @property
    def name(self) -> str:
        """Its name."""
        ...

    def cancel_goal(self, goal_id: object) -> None:
        """End a goal, and stop; any thread."""
        ...

    def serve_requests(self) -> None:
        """Take over what clients have asked for; loop thread."""
        ...


ControllerT = TypeVar("ControllerT", bound=GoalController)
ResultT = TypeVar("ResultT", bound=GoalEnd)


@dataclass(frozen=True, slots=True)
class _RunningGoal:
    """A goal whose end a coroutine of the executor awaits."""

    handle: ServerGoalHandle
    ended: Future


class ControllerAction(ABC, Generic[ControllerT, ResultT]):
    """Hands goals to the controller, and brings its results to their clients.

    Goals come in on the executor's thread, which must be one; their ends on the loop thread. The
    loop is asked to serve each request at once, so that goals are cancelled and preempted even
    while the simulation stands still.
    """

    def __init__(
        self,
        controller: ControllerT,
        node: Node,
        loop: ControlLoop,
        executor: Executor,
        action_type: type[Any],
        name: str,
    ) -> None:
        """Offer the action.

        Args:
            controller: takes the goals.
            node: offers the action.
            loop: runs the controller.
            executor: spins the node.
            action_type: class of the action.
            name: of the action, such as '~/gripper_cmd'.
        """
        self.controller = controller
        self._loop = loop
        self._executor = executor
        self._logger = logging.getLogger(controller.name)
        self._running: dict[bytes, _RunningGoal] = {}
        self._idle = threading.Event()
        self._idle.set()
        self._server = ActionServer(
            node,
            action_type,
            name,
            self._await_end,
            goal_callback=self._answer,
            handle_accepted_callback=self._start,
            cancel_callback=self._cancel,
            result_timeout=RESULT_TIMEOUT_S,
        )

    @abstractmethod
    def accepts(self, goal: Any) -> bool:
        """Return whether to take a goal; the log says why not. Executor's thread."""

    @abstractmethod
    def submit(self, goal_id: bytes, goal: Any) -> ResultT | None:
        """Start a goal that was accepted; return its result if it has ended by that.

        Executor's thread.
        """

    @abstractmethod
    def result_message(self, result: ResultT) -> Any:
        """Return what the client is told. Executor's thread."""

    def wait_for_results(self) -> None:
        """Wait until the results of all goals are out; a control-plane thread."""
        self._idle.wait(EXECUTOR_TIMEOUT_S)
        let_executor_answer(self._executor)

    # Loop thread

    def handle_of(self, goal_id: bytes) -> ServerGoalHandle:
        """Return the handle of a running goal."""
        return self._running[goal_id].handle

    def finish(self, goal_id: bytes, result: ResultT) -> None:
        """End a goal; any thread."""
        settle(self._running[goal_id].ended, result, self._executor)

    # Executor's thread

    def destroy(self) -> None:
        """Withdraw the action."""
        self._server.destroy()

    def _answer(self, goal: Any) -> GoalResponse:
        self._logger.info("Received new action goal")
        return GoalResponse.ACCEPT if self.accepts(goal) else GoalResponse.REJECT

    def _start(self, handle: ServerGoalHandle) -> None:
        goal_id = bytes(handle.goal_id.uuid)
        self._idle.clear()
        self._running[goal_id] = _RunningGoal(handle, Future())
        handle.execute()
        result = self.submit(goal_id, handle.request)
        if result is not None:
            self.finish(goal_id, result)
            return
        self._logger.info("Accepted new action goal")
        self._loop.call(self.controller.serve_requests)

    def _cancel(self, handle: ServerGoalHandle) -> CancelResponse:
        # The handle is cancelling only after this has returned; the end is taken from the loop no
        # sooner, because it comes on this thread, too.
        self._logger.info("Got request to cancel goal")
        self.controller.cancel_goal(bytes(handle.goal_id.uuid))
        self._loop.call(self.controller.serve_requests)
        return CancelResponse.ACCEPT

    async def _await_end(self, handle: ServerGoalHandle) -> Any:
        goal_id = bytes(handle.goal_id.uuid)
        result = cast(ResultT, await self._running[goal_id].ended)
        match result.outcome:
            case Outcome.SUCCEEDED:
                handle.succeed()
            case Outcome.ABORTED:
                handle.abort()
            case Outcome.CANCELED:
                _cancel_by_itself(handle)
                handle.canceled()
        del self._running[goal_id]
        if not self._running:
            self._idle.set()
        return self.result_message(result)


def _cancel_by_itself(handle: ServerGoalHandle) -> None:
    """Let a goal be cancelled although no client asked for it.

    The way there leads through 'canceling', and rclpy has no public step to it for a server.
    """
    if not handle.is_cancel_requested:
        handle._update_state(GoalEvent.CANCEL_GOAL)  # pyright: ignore[reportPrivateUsage]
