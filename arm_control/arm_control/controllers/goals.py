"""What controllers with an action share: how goals end, and the request queue."""

import threading
from abc import abstractmethod
from collections import deque
from enum import Enum
from typing import Generic, Protocol, TypeVar

from arm_control.controllers.controller import Controller, ParametersT


def ended_at_deactivation(halted_by: str) -> str:
    """Return the message of a goal that ends with its controller: why it is halted, if it is."""
    if halted_by:
        return f"Goal aborted: {halted_by}."
    return "Current goal cancelled during deactivate transition."


def refused_while_inactive(halted_by: str) -> str:
    """Return the message of a goal for a controller that does not run; see above."""
    if halted_by:
        return f"Can't accept new action goals: {halted_by}."
    return "Can't accept new action goals. Controller is not running."


class GoalOutcome(Enum):
    """The state in which a goal ends."""

    SUCCEEDED = "succeeded"
    ABORTED = "aborted"
    CANCELED = "canceled"


class GoalEnd(Protocol):
    """How a goal ended."""

    @property
    def outcome(self) -> GoalOutcome:
        """The goal's last state."""
        ...

    @property
    def message(self) -> str:
        """Why it ended, in a sentence; may be empty."""
        ...


class GoalController(Controller[ParametersT]):
    """A controller that handles goals."""

    @abstractmethod
    def cancel_goal(self, goal_id: object) -> None:
        """Cancel a goal and stop; any thread."""

    @abstractmethod
    def serve_requests(self) -> None:
        """Process the clients' requests; loop thread."""


RequestT = TypeVar("RequestT")

SIMULATION_RESET = "Goal aborted: the simulation was reset."
SIMULATION_RESTORED = "Goal aborted: the simulation was restored to a snapshot without this goal."


class RequestQueue(Generic[RequestT]):
    """A queue that accepts requests only while it is open. Any thread."""

    def __init__(self) -> None:
        """Create a closed queue."""
        self._lock = threading.Lock()
        self._requests: deque[RequestT] = deque()
        self._is_open = False

    @property
    def is_open(self) -> bool:
        """Whether requests are accepted."""
        return self._is_open

    def __bool__(self) -> bool:
        """Whether there is a request; without the lock, because the loop asks in every cycle."""
        return bool(self._requests)

    def open(self) -> None:
        """Accept requests from now on."""
        with self._lock:
            self._is_open = True

    def close(self) -> list[RequestT]:
        """Accept no more requests; return the pending ones."""
        with self._lock:
            self._is_open = False
            return self._drain()

    def put(self, request: RequestT) -> bool:
        """Add a request; return whether it was accepted."""
        with self._lock:
            if self._is_open:
                self._append(request)
            return self._is_open

    def take(self) -> list[RequestT]:
        """Remove and return all requests in order."""
        with self._lock:
            return self._drain()

    def _append(self, request: RequestT) -> None:
        """Add a request; the lock is held."""
        self._requests.append(request)

    def _drain(self) -> list[RequestT]:
        requests = list(self._requests)
        self._requests.clear()
        return requests
