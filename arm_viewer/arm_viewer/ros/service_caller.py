"""Call a service from the executor's thread without waiting."""

import time
from collections.abc import Callable
from typing import Any

from rclpy.node import Node
from rclpy.task import Future

MAX_WAIT_S = 3.0
"""After this time a response counts as lost, and the next call is allowed."""
MAX_PATIENCE = 16.0
"""A server that was late once is waited for twice as long the next time, up to so many times."""


class ServiceCaller:
    """A service client with at most one pending call. Use it in the executor's thread."""

    def __init__(
        self, node: Node, service_class: Any, service: str, max_wait_s: float = MAX_WAIT_S
    ) -> None:
        """Create the client; a response that takes longer than `max_wait_s` counts as lost."""
        self.service = service
        self._max_wait_s = max_wait_s
        self._node = node
        self._client = node.create_client(service_class, service)
        self._pending: Future | None = None
        self._asked_s = 0.0
        self._patience = 1.0

    def ask(self, request: Any, then: Callable[[Any], None]) -> bool:
        """Call the service and pass its response to `then`; return whether the call was sent.

        It is not sent if the server is not available or an earlier call is pending.
        """
        if self._pending is not None and not self.is_overdue():
            return False
        if self.is_overdue():
            # Else a busy machine, on which every answer is late, would never have one.
            self._patience = min(2.0 * self._patience, MAX_PATIENCE)
        self.forget()
        if not self.is_ready():
            return False
        self._asked_s = time.monotonic()
        self._pending = self._client.call_async(request)
        self._pending.add_done_callback(lambda future: self._answer(future, then))
        return True

    def is_ready(self) -> bool:
        """Return whether the server is available."""
        return self._client.service_is_ready()

    def is_overdue(self) -> bool:
        """Return whether a response has not arrived in time."""
        late_s = time.monotonic() - self._asked_s
        return self._pending is not None and late_s >= self._patience * self._max_wait_s

    def close(self) -> None:
        """Destroy the client; a pending response is dropped."""
        self.forget()
        self._node.destroy_client(self._client)

    def forget(self) -> None:
        """Drop a pending response."""
        if self._pending is not None:
            pending, self._pending = self._pending, None
            self._client.remove_pending_request(pending)

    def _answer(self, future: Future, then: Callable[[Any], None]) -> None:
        if future is self._pending:
            self._pending, self._patience = None, 1.0
            then(future.result())
