"""Calls functions of the launch file while everything stops, beside the loop and not for long."""

from __future__ import annotations

import os
import threading
from collections import deque
from collections.abc import Callable, Sequence

from launch_py.errors import LaunchError
from launch_py.plan import Step
from launch_py.supervision.event_loop import EventLoop, Timer

LIMIT_S = 5.0
"""How long one function may take; then it is left alone, and so are those that follow it."""

PATIENCE_S = 0.1
"""How long the loop itself waits for a function: what most of them print is then not mixed with
what the loop prints."""

Expand = Callable[[], Sequence[Step]]
Outcome = Sequence[Step] | LaunchError


def outcome_of(expand: Expand) -> Outcome:
    """Return the steps of a function of the launch file, or what it has raised.

    Whatever that is, also by sys.exit(), the loop goes on: the processes are to end in order.
    """
    try:
        return expand()
    except LaunchError as error:
        return error
    except BaseException as error:
        return LaunchError(f"an event handler: {type(error).__name__}: {error}")


class LateCalls:
    """Calls one function after the other in a thread beside the loop.

    In the loop's thread a function that waits for something would keep processes from being
    stopped, and the loop from seeing a second Ctrl-C. All methods belong to the loop's thread.

    Args:
        loop: the event loop.
        on_late: called once when a function has taken too long.
    """

    def __init__(self, loop: EventLoop, on_late: Callable[[], None]) -> None:
        self._loop = loop
        self._on_late = on_late
        self._waiting: deque[tuple[Expand, Callable[[Outcome], None]]] = deque()
        self._running = False
        self._given_up = False
        self._outcome: Outcome = ()
        self._limit: Timer | None = None
        self._pipe: tuple[int, int] | None = None

    @property
    def busy(self) -> bool:
        """Whether a function is to be waited for."""
        return not self._given_up and (self._running or bool(self._waiting))

    def call(self, expand: Expand, then: Callable[[Outcome], None]) -> None:
        """Call `expand` when its turn comes, and `then` with its steps or its error."""
        if not self._given_up:
            self._waiting.append((expand, then))
            self._start_next()

    def give_up(self) -> None:
        """Wait for none of them any more."""
        self._given_up = True
        self._waiting.clear()
        if self._limit is not None:
            self._limit.cancel()

    def _start_next(self) -> None:
        if self._running or not self._waiting:
            return
        self._running = True
        if self._pipe is None:
            self._pipe = os.pipe()
            self._loop.add_reader(self._pipe[0], self._deliver)
        self._limit = self._loop.call_later(LIMIT_S, self._too_late)
        # A daemon: the supervisor ends without it.
        thread = threading.Thread(target=self._run, args=(self._waiting[0][0],), daemon=True)
        thread.start()
        thread.join(PATIENCE_S)
        if not thread.is_alive():
            self._deliver()

    def _run(self, expand: Expand) -> None:
        self._outcome = outcome_of(expand)
        if self._pipe is not None:
            os.write(self._pipe[1], b"\n")

    def _deliver(self) -> None:
        if self._pipe is not None:
            os.read(self._pipe[0], 1)
        if self._given_up:
            return
        if self._limit is not None:
            self._limit.cancel()
        then = self._waiting.popleft()[1]
        self._running = False
        then(self._outcome)
        self._start_next()

    def _too_late(self) -> None:
        self.give_up()
        self._on_late()
