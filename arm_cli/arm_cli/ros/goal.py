"""A goal from being sent to its result, printed as ros2 prints it."""

from typing import Any

from action_msgs.msg import GoalStatus
from rclpy.action.client import ActionClient, ClientGoalHandle

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

    def is_ready(self) -> bool:
        """Return whether a server is there."""
        return self._client.server_is_ready()

    def send(self, goal: FilledMessage, with_feedback: bool) -> None:
        """Send a goal, wait for its result and print both; a signal cancels it.

        Raises:
            UnansweredError: the server does not cancel it.
            StoppedError: a signal came, and the goal is cancelled.
        """
        goal.stamp(self._session.node.get_clock().now().to_msg())
        print(f"Sending goal:\n     {to_yaml(goal.message)}")
        feedback = _print_feedback if with_feedback else None
        handle = self._session.result(self._client.send_goal_async(goal.message, feedback))
        if not handle.accepted:
            print("Goal was rejected.")
            return
        print(f"Goal accepted with ID: {bytes(handle.goal_id.uuid).hex()}\n")
        try:
            answer = self._session.result(handle.get_result_async())
        except StoppedError:
            self._cancel(handle)
            raise
        print(f"Result:\n    {to_yaml(answer.result)}")
        print(f"Goal finished with status: {_STATUS_NAMES.get(answer.status, 'UNKNOWN')}")

    def _cancel(self, handle: ClientGoalHandle) -> None:
        self._session.go_on()
        print("Canceling goal...")
        answer = self._session.result(handle.cancel_goal_async(), CANCEL_TIMEOUT_S)
        if answer is None or not answer.goals_canceling:
            raise UnansweredError(f"{self.name} did not cancel the goal")
        print("Goal canceled.")


def _print_feedback(message: Any) -> None:
    print(f"Feedback:\n    {to_yaml(message.feedback)}")
