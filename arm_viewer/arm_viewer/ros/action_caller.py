"""Send goals to an action from the executor's thread without waiting."""

import math
import time
import uuid
from collections.abc import Callable
from typing import Any

from action_msgs.msg import GoalStatus
from action_msgs.srv import CancelGoal
from rclpy.node import Node
from unique_identifier_msgs.msg import UUID

from arm_viewer.ros.service_caller import ServiceCaller

End = Callable[[Any, str], None]
"""Takes the result of a goal and "", or None and a sentence that says why there is none."""


class ActionCaller:
    """An action client with at most one goal. Use it in the executor's thread.

    A goal, its result and its cancelling are calls to services. Feedback is not subscribed to.
    """

    def __init__(self, node: Node, action_class: Any, action: str) -> None:
        """Create the clients."""
        self._action = action
        self._impl = action_class.Impl
        service = f"{action}/_action"
        self._send = ServiceCaller(node, self._impl.SendGoalService, f"{service}/send_goal")
        self._get = ServiceCaller(
            node, self._impl.GetResultService, f"{service}/get_result", math.inf
        )
        self._cancel = ServiceCaller(node, CancelGoal, f"{service}/cancel_goal")
        self._goal_id: UUID | None = None
        self._end: End | None = None
        self._latest_s = math.inf
        self._is_canceled = self._is_accepted = False
        self.status = GoalStatus.STATUS_UNKNOWN
        """The action_msgs/msg/GoalStatus with which the last goal ended."""

    @property
    def is_busy(self) -> bool:
        """Whether a goal is under way."""
        return self._end is not None

    @property
    def is_accepted(self) -> bool:
        """Whether the server has accepted the goal under way."""
        return self.is_busy and self._is_accepted

    def is_ready(self) -> bool:
        """Return whether the server is available."""
        return all(caller.is_ready() for caller in (self._send, self._get, self._cancel))

    def is_goal(self, goal_id: UUID) -> bool:
        """Return whether an identifier is that of the goal under way."""
        return self.is_busy and goal_id == self._goal_id

    def start(self, goal: Any, end: End, max_wait_s: float = math.inf) -> None:
        """Send a goal; a goal that is under way is forgotten.

        `end` is called once, when the goal ends or counts as lost, as after `max_wait_s`.
        """
        self._get.forget()
        self._goal_id = UUID(uuid=list(uuid.uuid4().bytes))
        self._end = end
        self._is_canceled = self._is_accepted = False
        self._latest_s = time.monotonic() + max_wait_s
        request = self._impl.SendGoalService.Request(goal_id=self._goal_id, goal=goal)
        if not self._send.ask(request, self._take_acceptance):
            self._finish(None, f"{self._action} is not available; try again")

    def cancel(self) -> None:
        """Ask the server to cancel the goal; its result says what came of it."""
        if self._goal_id is not None and self.is_busy:
            # A server that has not taken the goal yet would not know it: see `_take_acceptance`.
            self._is_canceled = True
            request = CancelGoal.Request()
            request.goal_info.goal_id = self._goal_id
            self._cancel.ask(request, lambda _: None)

    def check(self) -> None:
        """End a goal whose server has disappeared or is late; call it periodically."""
        if not self.is_busy:
            return
        if not self._get.is_ready():
            self._finish(None, f"the server of {self._action} has ended")
        elif self._send.is_overdue() or time.monotonic() > self._latest_s:
            self._finish(None, f"{self._action} does not answer")

    def close(self) -> None:
        """Destroy the clients; a goal that is under way is forgotten."""
        self._end = None
        for caller in (self._send, self._get, self._cancel):
            caller.close()

    def _take_acceptance(self, answer: Any) -> None:
        if not answer.accepted:
            self._finish(None, f"{self._action} has refused the goal")
            return
        self._is_accepted = True
        request = self._impl.GetResultService.Request(goal_id=self._goal_id)
        if not self._get.ask(request, self._take_result):
            self._finish(None, f"the server of {self._action} has ended")
        elif self._is_canceled:
            self.cancel()

    def _take_result(self, answer: Any) -> None:
        self.status = answer.status
        self._finish(answer.result, "")

    def _finish(self, result: Any, problem: str) -> None:
        end, self._end = self._end, None
        self._send.forget()
        self._get.forget()
        if end is not None:
            end(result, problem)
