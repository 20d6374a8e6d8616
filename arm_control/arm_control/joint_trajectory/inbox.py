"""Requests on their way from the threads of clients to the control loop."""

import threading
from collections import deque
from dataclasses import dataclass

from arm_control.joint_trajectory.requests import GoalRequest
from arm_control.joint_trajectory.trajectory import Trajectory


@dataclass(frozen=True, slots=True)
class GoalStart:
    """A goal is to start."""

    goal: GoalRequest
    trajectory: Trajectory


@dataclass(frozen=True, slots=True)
class GoalCancel:
    """A goal is to end."""

    goal_id: object


@dataclass(frozen=True, slots=True)
class Replacement:
    """A trajectory without a goal is to start."""

    trajectory: Trajectory


Request = GoalStart | GoalCancel | Replacement


class Inbox:
    """A queue that takes requests only while somebody is there to serve them. Any thread."""

    def __init__(self) -> None:
        """Start closed."""
        self._lock = threading.Lock()
        self._requests: deque[Request] = deque()
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

    def close(self) -> list[Request]:
        """Take no more requests; return those not served."""
        with self._lock:
            self._is_open = False
            return self._drain()

    def put(self, request: Request) -> bool:
        """Add a request; return whether it was taken.

        A stream of trajectories does not pile up while the loop stands still: one takes the place
        of another right before it.
        """
        with self._lock:
            if not self._is_open:
                return False
            last = self._requests[-1] if self._requests else None
            if isinstance(request, Replacement) and isinstance(last, Replacement):
                self._requests.pop()
            self._requests.append(request)
            return True

    def take(self) -> list[Request]:
        """Return all requests in their order, and forget them."""
        with self._lock:
            return self._drain()

    def _drain(self) -> list[Request]:
        requests = list(self._requests)
        self._requests.clear()
        return requests
