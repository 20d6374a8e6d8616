"""Asks a service from within the executor's thread, without waiting there."""

import time
from collections.abc import Callable
from typing import Any

from rclpy.node import Node
from rclpy.task import Future

LONGEST_WAIT_S = 3.0
"""After this an answer is taken for lost, and the next question may be asked."""


class Inquiry:
    """A service client with at most one question under way. Use it in the executor's thread."""

    def __init__(self, node: Node, service_class: Any, service: str) -> None:
        """Make the client."""
        self._node = node
        self._client = node.create_client(service_class, service)
        self._pending: Future | None = None
        self._asked_s = 0.0

    def ask(self, request: Any, then: Callable[[Any], None]) -> bool:
        """Ask, and have the answer handed to `then` once it comes; return whether it was asked.

        It is not where the server is not there, or where an earlier question is under way.
        """
        now_s = time.monotonic()
        if self._pending is not None and now_s - self._asked_s < LONGEST_WAIT_S:
            return False
        self._forget()
        if not self._client.service_is_ready():
            return False
        self._asked_s = now_s
        self._pending = self._client.call_async(request)
        self._pending.add_done_callback(lambda future: self._answer(future, then))
        return True

    def close(self) -> None:
        """End the client; an answer under way is not handed on."""
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
