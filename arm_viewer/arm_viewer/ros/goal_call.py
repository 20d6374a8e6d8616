"""One goal of an action, with its feedback and its result."""

import time
from typing import Any

from action_msgs.msg import GoalStatus
from rclpy.node import Node

from arm_node.messages.filling import FilledMessage
from arm_node.testing import DiscoveryCheck
from arm_viewer.calls.call import CallState, failure, shown
from arm_viewer.ros.action_caller import ActionCaller
from arm_viewer.ros.service_call import FIND_S, KNOWN_S, Report

SHOW_S = 0.2
"""Least time between two feedbacks that are shown."""
_ENDS = {
    GoalStatus.STATUS_SUCCEEDED: "Succeeded",
    GoalStatus.STATUS_CANCELED: "Canceled",
    GoalStatus.STATUS_ABORTED: "Aborted by the server",
}


class GoalCall:
    """Sends a goal, and reports what becomes of it."""

    def __init__(
        self, node: Node, action_class: Any, name: str, filled: FilledMessage, report: Report
    ) -> None:
        """Look for the server; `check` does the rest."""
        self._node = node
        self._name = name
        self._filled = filled
        self._report = report
        self._caller = ActionCaller(node, action_class, name)
        self._feedback: Any = None
        self._subscription = node.create_subscription(
            action_class.Impl.FeedbackMessage, f"{name}/_action/feedback", self._take, 10
        )
        self._known = DiscoveryCheck.with_server(node, f"{name}/_action/send_goal")
        self._start_s = time.monotonic()
        self._shown_s = 0.0
        self._is_sent = self._is_canceled = False
        report(CallState("Waiting for the server"))

    def check(self, now_s: float) -> None:
        """Send the goal when that is possible; report feedback, and a server that has ended."""
        if not self._is_sent:
            if self._is_known(now_s):
                self._is_sent = True
                self._filled.stamp(self._node.get_clock().now().to_msg())
                self._report(CallState("Sent"))
                self._caller.start(self._filled.message, self._end)
            elif now_s - self._start_s > FIND_S:
                self._report(failure(f"no server offers {self._name}"))
            return
        self._caller.check()
        if self._caller.is_busy and now_s - self._shown_s >= SHOW_S:
            self._shown_s = now_s
            since_s = now_s - self._start_s
            text = f"Accepted, under way for {since_s:.0f} s"
            if self._is_canceled:
                text = "Canceling"
            elif not self._caller.is_accepted:
                text = "Sent, not accepted yet"
            newest = "" if self._feedback is None else shown(self._feedback)
            self._report(CallState(text, newest))

    def cancel(self) -> None:
        """Ask the server to cancel the goal."""
        self._is_canceled = True
        if self._is_sent:
            self._caller.cancel()
        else:
            self._report(failure("Canceled before it was sent"))

    def close(self) -> None:
        """Destroy the clients and the subscription."""
        self._known.close()
        self._node.destroy_subscription(self._subscription)
        self._caller.close()

    def _is_known(self, now_s: float) -> bool:
        """Return whether the server will find this node; an answer sent earlier is lost."""
        if not self._caller.is_ready():
            return False
        return self._known.complete or now_s - self._start_s > KNOWN_S

    def _take(self, message: Any) -> None:
        if self._caller.is_goal(message.goal_id):
            self._feedback = message.feedback

    def _end(self, result: Any, problem: str) -> None:
        if problem:
            self._report(failure(problem))
            return
        status = self._caller.status
        took_s = time.monotonic() - self._start_s
        text = f"{_ENDS.get(status, 'Ended')} after {took_s:.1f} s"
        is_failed = status != GoalStatus.STATUS_SUCCEEDED
        self._report(CallState(text, shown(result), is_over=True, is_failed=is_failed))
