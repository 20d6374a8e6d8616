"""The action ~/follow_joint_trajectory."""

import logging
import threading
from collections.abc import Callable
from dataclasses import dataclass
from typing import cast

from control_msgs.action import FollowJointTrajectory
from rclpy.action.server import ActionServer, CancelResponse, GoalResponse, ServerGoalHandle
from rclpy.executors import Executor
from rclpy.node import Node
from rclpy.task import Future

from arm_control.control_loop import ControlLoop
from arm_control.joint_trajectory import (
    Feedback,
    GoalResult,
    JointTrajectoryController,
    Outcome,
    StateLayout,
)
from arm_control.ros.executor_bridge import EXECUTOR_TIMEOUT_S, settle
from arm_control.ros.joint_trajectory_messages import (
    feedback_message,
    goal_request,
    result_message,
    trajectory_request,
)


@dataclass(frozen=True, slots=True)
class _RunningGoal:
    """A goal whose end a coroutine of the executor awaits."""

    handle: ServerGoalHandle
    ended: Future


class JointTrajectoryAction:
    """Hands goals to the controller, and brings its results to their clients.

    Goals come in on the executor's thread, which must be one; their ends on the loop thread. The
    loop is asked to serve each request at once, so that goals are cancelled and preempted even
    while the simulation stands still.
    """

    def __init__(
        self,
        controller: JointTrajectoryController,
        node: Node,
        loop: ControlLoop,
        executor: Executor,
        accepts_faulty: Callable[[], bool],
    ) -> None:
        """Offer the action.

        Args:
            controller: takes the goals.
            node: offers the action.
            loop: runs the controller.
            executor: spins the node.
            accepts_faulty: whether a goal with a fault is accepted, and aborted with the reason.
        """
        self._controller = controller
        self._loop = loop
        self._executor = executor
        self._accepts_faulty = accepts_faulty
        self._logger = logging.getLogger(controller.name)
        self._running: dict[bytes, _RunningGoal] = {}
        self._idle = threading.Event()
        self._idle.set()
        self._server = ActionServer(
            node,
            FollowJointTrajectory,
            "~/follow_joint_trajectory",
            self._await_end,
            goal_callback=self._answer,
            handle_accepted_callback=self._start,
            cancel_callback=self._cancel,
        )

    def wait_for_results(self) -> None:
        """Wait until the results of all goals are out; a control-plane thread."""
        self._idle.wait(EXECUTOR_TIMEOUT_S)

    # Loop thread

    def publish_feedback(self, goal_id: bytes, layout: StateLayout, feedback: Feedback) -> None:
        """Tell how a goal is getting on."""
        self._running[goal_id].handle.publish_feedback(feedback_message(layout, feedback))

    def finish(self, goal_id: bytes, result: GoalResult) -> None:
        """End a goal; any thread."""
        settle(self._running[goal_id].ended, result, self._executor)

    # Executor's thread

    def destroy(self) -> None:
        """Withdraw the action."""
        self._server.destroy()

    def _answer(self, goal: FollowJointTrajectory.Goal) -> GoalResponse:
        self._logger.info("Received new action goal")
        refusal = self._controller.check_goal(trajectory_request(goal.trajectory))
        if refusal is not None and not self._accepts_faulty():
            return GoalResponse.REJECT
        return GoalResponse.ACCEPT

    def _start(self, handle: ServerGoalHandle) -> None:
        goal_id = bytes(handle.goal_id.uuid)
        self._idle.clear()
        self._running[goal_id] = _RunningGoal(handle, Future())
        handle.execute()
        result = self._controller.submit_goal(goal_request(goal_id, handle.request))
        if result is not None:
            self.finish(goal_id, result)
            return
        self._logger.info("Accepted new action goal")
        self._loop.call(self._controller.serve_requests)

    def _cancel(self, handle: ServerGoalHandle) -> CancelResponse:
        # The handle is cancelling only after this has returned; the end is taken from the loop no
        # sooner, because it comes on this thread, too.
        self._logger.info("Got request to cancel goal")
        self._controller.cancel_goal(bytes(handle.goal_id.uuid))
        self._loop.call(self._controller.serve_requests)
        return CancelResponse.ACCEPT

    async def _await_end(self, handle: ServerGoalHandle) -> FollowJointTrajectory.Result:
        goal_id = bytes(handle.goal_id.uuid)
        result = cast(GoalResult, await self._running[goal_id].ended)
        match result.outcome:
            case Outcome.SUCCEEDED:
                handle.succeed()
            case Outcome.ABORTED:
                handle.abort()
            case Outcome.CANCELED:
                handle.canceled()
        del self._running[goal_id]
        if not self._running:
            self._idle.set()
        return result_message(result)
