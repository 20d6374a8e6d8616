"""Requests on their way from the threads of clients to the control loop."""

import threading
from collections import deque
from typing import Generic, TypeVar

RequestT = TypeVar("RequestT")


class RequestQueue(Generic[RequestT]):
    """A queue that takes requests only while somebody is there to serve them. Any thread."""

    def __init__(self) -> None:
        """Start closed."""
        self._lock = threading.Lock()
        self._requests: deque[RequestT] = deque()
        self._is_open = False

    @property
    def is_open(self) -> bool:
        """Whether requests are taken."""
        return self._is_open

    def __bool__(self) -> bool:
        """Whether there is a request; without the lock, for the loop asks in every cycle."""
        return bool(self._requests)

    def open(self) -> None:
        """Take requests from now on."""
        with self._lock:
            self._is_open = True

    def close(self) -> list[RequestT]:
        """Take no more requests; return those not served."""
        with self._lock:
            self._is_open = False
            return self._drain()

    def put(self, request: RequestT) -> bool:
        """Add a request; return whether it was taken."""
        with self._lock:
            if self._is_open:
                self._append(request)
            return self._is_open

    def take(self) -> list[RequestT]:
        """Return all requests in their order, and forget them."""
        with self._lock:
            return self._drain()

    def _append(self, request: RequestT) -> None:
        """Add a request; the lock is held."""
        self._requests.append(request)

    def _drain(self) -> list[RequestT]:
        requests = list(self._requests)
        self._requests.clear()
        return requests
