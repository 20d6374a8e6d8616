"""Sends a goal and prints its progress and result as ros2 does.

The response to a goal has no field for a reason of its refusal, and neither have most results. So
the reason is taken from what the server logs.
"""

import time
from typing import Any

from action_msgs.msg import GoalStatus
from rcl_interfaces.msg import Log
from rclpy.action.client import ActionClient, ClientGoalHandle
from rclpy.action.graph import get_action_server_names_and_types_by_node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rclpy.task import Future

from arm_cli.errors import StoppedError, UnansweredError
from arm_cli.output import say, say_document
from arm_cli.ros.session import CommandSession
from arm_node.messages.filling import FilledMessage
from arm_node.messages.text import to_yaml

WAIT_S = 1.0
"""How long a reason may arrive after the response, on another connection."""
ROSOUT_QOS = QoSProfile(
    depth=1000,
    reliability=ReliabilityPolicy.RELIABLE,
    # What was logged before this subscription was discovered arrives as well.
    durability=DurabilityPolicy.TRANSIENT_LOCAL,
)


class RefusalListener:
    """Listens to /rosout from the sending of a goal on."""

    def __init__(self, session: CommandSession, action_name: str) -> None:
        """Subscribe for the action of this full name."""
        self._session = session
        self._action_name = action_name
        self._logged: list[Log] = []
        self._since_ns = 0
        self._subscription = session.node.create_subscription(
            Log, "/rosout", self._logged.append, ROSOUT_QOS
        )

    def close(self) -> None:
        """Unsubscribe."""
        self._session.node.destroy_subscription(self._subscription)

    def begin(self, system_ns: int) -> None:
        """Forget what was logged before this system time."""
        self._since_ns = system_ns
        self._logged.clear()

    def reason(self) -> str:
        """Return the latest warning or error of the action's server; "" if none arrives."""
        names = self._server_loggers()

        def found() -> list[str]:
            return [
                message.msg
                for message in self._logged
                if message.name in names
                and message.level >= Log.WARN
                and message.stamp.sec * 10**9 + message.stamp.nanosec >= self._since_ns
            ]

        self._session.wait_until(lambda: bool(found()), timeout_s=WAIT_S)
        reasons = found()
        return reasons[-1] if reasons else ""

    def _server_loggers(self) -> set[str]:
        """Return the names under which the nodes of the action's servers log."""
        node = self._session.node
        return {
            logger
            for name, namespace in node.get_node_names_and_namespaces()
            if any(
                action == self._action_name
                for action, _ in get_action_server_names_and_types_by_node(node, name, namespace)
            )
            for logger in (name, f"{namespace}.{name}".replace("/", ".").lstrip("."))
        }


CANCEL_TIMEOUT_S = 5.0

_STATUS_NAMES = {
    GoalStatus.STATUS_ACCEPTED: "ACCEPTED",
    GoalStatus.STATUS_EXECUTING: "EXECUTING",
    GoalStatus.STATUS_CANCELING: "CANCELING",
    GoalStatus.STATUS_SUCCEEDED: "SUCCEEDED",
    GoalStatus.STATUS_CANCELED: "CANCELED",
    GoalStatus.STATUS_ABORTED: "ABORTED",
}


class GoalSender:
    """Sends goals to one action."""

    def __init__(self, session: CommandSession, action_class: Any, name: str) -> None:
        """Create the action client on the session's node."""
        self.name = name
        self._session = session
        self._client = ActionClient(session.node, action_class, name)
        self._refusals = RefusalListener(session, name)

    def close(self) -> None:
        """Destroy the action client, because its node does not."""
        self._client.destroy()
        self._refusals.close()

    def is_ready(self) -> bool:
        """Return whether the action has a server."""
        return self._client.server_is_ready()

    def wait_until_known(self) -> None:
        """Wait until the server has discovered this client."""
        self._session.be_known_to_server(f"{self.name}/_action/send_goal")

    def send(
        self, goal: FilledMessage, with_feedback: bool, timeout_s: float | None = None
    ) -> None:
        """Send a goal, wait for its result and print both; a signal or the timeout cancels it.

        Raises:
            UnansweredError: the server does not answer, ends, does not cancel the goal, or has no
                result before the timeout.
            StoppedError: a signal arrived, and the goal was cancelled.
        """
        goal.stamp(self._session.node.get_clock().now().to_msg())
        say_document(f"Sending goal:\n     {to_yaml(goal.message)}")
        feedback = _print_feedback if with_feedback else None
        self._refusals.begin(time.time_ns())
        sent = self._client.send_goal_async(goal.message, feedback)
        try:
            if self._wait_for_result(sent, timeout_s):
                return
        except StoppedError:
            self._cancel(sent)
            raise
        self._cancel(sent)
        raise UnansweredError(f"no result from {self.name} within {timeout_s:g} s")

    def _wait_for_result(self, sent: Future, timeout_s: float | None) -> bool:
        """Print the progress and result of a goal; return whether it ended before the timeout."""
        start_s = time.monotonic()
        handle: ClientGoalHandle | None = self._answer(
            sent, timeout_s, f"waiting for {self.name} to accept the goal..."
        )
        if handle is None:
            return False
        if not handle.accepted:
            say("Goal was rejected.")
            self._explain()
            return True
        say_document(f"Goal accepted with ID: {bytes(handle.goal_id.uuid).hex()}\n")
        left_s = None if timeout_s is None else timeout_s - (time.monotonic() - start_s)
        answer = self._answer(
            handle.get_result_async(), left_s, f"waiting for the result of {self.name}..."
        )
        if answer is None:
            return False
        say_document(f"Result:\n    {to_yaml(answer.result)}")
        say(f"Goal finished with status: {_STATUS_NAMES.get(answer.status, 'UNKNOWN')}")
        if answer.status == GoalStatus.STATUS_ABORTED and not _has_reason(answer.result):
            self._explain()
        return True

    def _answer(self, future: Future, timeout_s: float | None, waiting_for: str) -> Any:
        is_there = self._client.server_is_ready
        return self._session.answer(future, self.name, is_there, timeout_s, lambda: waiting_for)

    def _explain(self) -> None:
        """Print why the goal failed, if its server logs that."""
        if reason := self._refusals.reason():
            say(f"Reason, from the server's log: {reason}")

    def _cancel(self, sent: Future) -> None:
        # The server may have accepted the goal although its response has not arrived yet.
        self._session.clear_stop()
        handle: ClientGoalHandle | None = self._session.result(sent, CANCEL_TIMEOUT_S)
        if handle is None:
            raise UnansweredError(f"{self.name} did not answer; an accepted goal is still running")
        if not handle.accepted:
            return
        say("Canceling goal...")
        answer = self._session.result(handle.cancel_goal_async(), CANCEL_TIMEOUT_S)
        if answer is None or not answer.goals_canceling:
            raise UnansweredError(f"{self.name} did not cancel the goal")
        say("Goal canceled.")


def _has_reason(result: Any) -> bool:
    return bool(getattr(result, "error_string", ""))


def _print_feedback(message: Any) -> None:
    say_document(f"Feedback:\n    {to_yaml(message.feedback)}")
