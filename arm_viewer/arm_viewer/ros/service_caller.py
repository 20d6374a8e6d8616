"""Call a service from the executor's thread without waiting."""

import time
from collections.abc import Callable
from typing import Any

from rclpy.node import Node
from rclpy.task import Future

MAX_WAIT_S = 3.0
"""After this time a response counts as lost, and the next call is allowed."""


class ServiceCaller:
    """A service client with at most one pending call. Use it in the executor's thread."""

    def __init__(self, node: Node, service_class: Any, service: str) -> None:
        """Create the client."""
        self._node = node
        self._client = node.create_client(service_class, service)
        self._pending: Future | None = None
        self._asked_s = 0.0

    def ask(self, request: Any, then: Callable[[Any], None]) -> bool:
        """Call the service and pass its response to `then`; return whether the call was sent.

        It is not sent if the server is not available or an earlier call is pending.
        """
        now_s = time.monotonic()
        if self._pending is not None and now_s - self._asked_s < MAX_WAIT_S:
            return False
        self._forget()
        if not self._client.service_is_ready():
            return False
        self._asked_s = now_s
        self._pending = self._client.call_async(request)
        self._pending.add_done_callback(lambda future: self._answer(future, then))
        return True

    def close(self) -> None:
        """Destroy the client; a pending response is dropped."""
        self._forget()
        self._node.destroy_client(self._client)

    def _answer(self, future: Future, then: Callable[[Any], None]) -> None:
        if future is self._pending:
            self._pending = None
            then(future.result())

    def _forget(self) -> None:
        if self._pending is not None:
            pending, self._pending = self._pending, None
            self._client.remove_pending_request(pending)
