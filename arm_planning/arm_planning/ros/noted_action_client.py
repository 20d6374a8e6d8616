"""An action client for several threads."""

import threading
from typing import Any

from rclpy.action.client import ActionClient


class NotedActionClient(ActionClient):
    """Loses no answer that is quicker than the note of its request.

    rclpy sends a request and then notes it. Another thread of the executor that takes the answer in
    between finds no note, and drops the answer: the goal never ends for this client.
    """

    def __init__(self, *arguments: Any, **options: Any) -> None:
        # Before rclpy adds the client to the executor.
        self._noting = threading.Lock()
        super().__init__(*arguments, **options)

    def send_goal_async(self, *arguments: Any, **options: Any) -> Any:
        """See `ActionClient`."""
        with self._noting:
            return super().send_goal_async(*arguments, **options)

    def _cancel_goal_async(self, goal_handle: Any) -> Any:
        with self._noting:
            return super()._cancel_goal_async(goal_handle)

    def _get_result_async(self, goal_handle: Any) -> Any:
        with self._noting:
            return super()._get_result_async(goal_handle)

    async def execute(self, taken_data: Any) -> None:
        """Handle answers, once the requests that are being sent are noted."""
        with self._noting:
            pass
        await super().execute(taken_data)
