"""A goal from being sent to its result, printed as ros2 prints it."""

from typing import Any

from action_msgs.msg import GoalStatus
from rclpy.action.client import ActionClient, ClientGoalHandle
from rclpy.task import Future

from arm_cli.errors import StoppedError, UnansweredError
from arm_cli.messages.filling import FilledMessage
from arm_cli.messages.text import to_yaml
from arm_cli.ros.session import Session

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
    """Sends goals to one action.

    Attributes:
        name: of the action.
    """

    def __init__(self, session: Session, action_class: Any, name: str) -> None:
        """Make the action client on the session's node."""
        self.name = name
        self._session = session
        self._client = ActionClient(session.node, action_class, name)

    def close(self) -> None:
        """Destroy the action client, which its node does not do for it."""
        self._client.destroy()

    def is_ready(self) -> bool:
        """Return whether a server is there."""
        return self._client.server_is_ready()

    def send(self, goal: FilledMessage, with_feedback: bool) -> None:
        """Send a goal, wait for its result and print both; a signal cancels it.

        Raises:
            UnansweredError: the server does not answer, or does not cancel it.
            StoppedError: a signal came, and the goal is cancelled.
        """
        goal.stamp(self._session.node.get_clock().now().to_msg())
        print(f"Sending goal:\n     {to_yaml(goal.message)}")
        feedback = _print_feedback if with_feedback else None
        sent = self._client.send_goal_async(goal.message, feedback)
        try:
            self._follow(sent)
        except StoppedError:
            self._cancel(sent)
            raise

    def _follow(self, sent: Future) -> None:
        handle: ClientGoalHandle = self._session.result(sent)
        if not handle.accepted:
            print("Goal was rejected.")
            return
        print(f"Goal accepted with ID: {bytes(handle.goal_id.uuid).hex()}\n")
        answer = self._session.result(handle.get_result_async())
        print(f"Result:\n    {to_yaml(answer.result)}")
        print(f"Goal finished with status: {_STATUS_NAMES.get(answer.status, 'UNKNOWN')}")

    def _cancel(self, sent: Future) -> None:
        # A server may have started it though its answer is still on its way.
        self._session.go_on()
        handle: ClientGoalHandle | None = self._session.result(sent, CANCEL_TIMEOUT_S)
        if handle is None:
            raise UnansweredError(f"{self.name} did not answer; if it took the goal, that goes on")
        if not handle.accepted:
            return
        print("Canceling goal...")
        answer = self._session.result(handle.cancel_goal_async(), CANCEL_TIMEOUT_S)
        if answer is None or not answer.goals_canceling:
            raise UnansweredError(f"{self.name} did not cancel the goal")
        print("Goal canceled.")


def _print_feedback(message: Any) -> None:
    print(f"Feedback:\n    {to_yaml(message.feedback)}")
