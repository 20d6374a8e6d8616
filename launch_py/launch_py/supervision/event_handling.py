"""Calls the event handlers of a launch file, in the loop's thread or beside it."""

from __future__ import annotations

import os
import threading
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from typing import Any, TypeVar

from launch_py.errors import LaunchError
from launch_py.events import (
    ProcessEvent,
    ProcessExited,
    ProcessIO,
    ProcessStarted,
    ProcessStderr,
    ProcessStdout,
)
from launch_py.plan.steps import DeferredStep, Step, TriggerKind
from launch_py.supervision.event_loop import EventLoop, Timer
from launch_py.supervision.managed_process import ManagedProcess

HANDLER_TIMEOUT_S = 5.0
"""How long a handler may take during the shutdown. After that no further handler is called."""

JOIN_TIMEOUT_S = 0.1
"""How long the loop first waits for a handler, so that the output of both is not mixed."""

EventT = TypeVar("EventT")
Expand = Callable[[], Sequence[Step]]
HandlerResult = Sequence[Step] | LaunchError


def started_event(process: ManagedProcess) -> ProcessStarted:
    """Return the event of the start of a process."""
    return _event(ProcessStarted, process)


def exited_event(process: ManagedProcess) -> ProcessExited:
    """Return the event of the end of a process."""
    return _event(ProcessExited, process, returncode=process.exit_code)


def line_event(process: ManagedProcess, stream: str, text: str) -> ProcessIO:
    """Return the event of a line that a process has written to "stdout" or "stderr"."""
    kind, fd = (ProcessStderr, 2) if stream == "stderr" else (ProcessStdout, 1)
    return _event(kind, process, text=f"{text}\n".encode(), fd=fd)


def awaited_event(
    step: DeferredStep, processes: Mapping[str, ManagedProcess]
) -> ProcessEvent | None:
    """Return the last event that a step waited for, or None if it waited for no event."""
    if not step.after:
        return None
    trigger = step.after[-1]
    process = processes[str(trigger.process)]
    exited = trigger.kind is TriggerKind.EXITED
    return exited_event(process) if exited else started_event(process)


def _event(kind: Callable[..., EventT], process: ManagedProcess, **more: Any) -> EventT:
    child, step = process.child, process.step
    return kind(
        action=step.action,
        process_name=process.name,
        cmd=tuple(map(str, step.command if child is None else child.spec.command)),
        cwd=step.cwd,
        env={} if child is None else child.spec.environment,
        pid=0 if child is None else child.pid,
        **more,
    )


def call_handler(expand: Expand) -> HandlerResult:
    """Return the steps that a function of the launch file returns, or its error.

    The loop survives any exception of the function, SystemExit included, because the processes must
    still be stopped in order.
    """
    try:
        return expand()
    except LaunchError as error:
        return error
    except BaseException as error:
        return LaunchError(f"an event handler: {type(error).__name__}: {error}")


class HandlerThread:
    """Calls event handlers one after the other in a thread beside the loop.

    It is used during the shutdown. A handler that blocked the loop's thread would prevent it from
    stopping processes and from seeing a second Ctrl-C. All methods belong to the loop's thread.
    `on_timeout` is called once when a handler has taken too long.
    """

    def __init__(self, loop: EventLoop, on_timeout: Callable[[], None]) -> None:
        self._loop = loop
        self._on_timeout = on_timeout
        self._waiting: deque[tuple[Expand, Callable[[HandlerResult], None]]] = deque()
        self._running = False
        self._given_up = False
        self._outcome: HandlerResult = ()
        self._limit: Timer | None = None
        self._pipe: tuple[int, int] | None = None

    @property
    def busy(self) -> bool:
        """Whether a handler is running or waiting for its turn."""
        return not self._given_up and (self._running or bool(self._waiting))

    def call(self, expand: Expand, then: Callable[[HandlerResult], None]) -> None:
        """Call `expand` after the handlers before it, and `then` with its steps or its error."""
        if not self._given_up:
            self._waiting.append((expand, then))
            self._start_next()

    def give_up(self) -> None:
        """Stop waiting for the handlers."""
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
        self._limit = self._loop.call_later(HANDLER_TIMEOUT_S, self._timed_out)
        # A daemon thread does not prevent the supervisor from exiting.
        thread = threading.Thread(target=self._run, args=(self._waiting[0][0],), daemon=True)
        thread.start()
        thread.join(JOIN_TIMEOUT_S)
        if not thread.is_alive():
            self._deliver()

    def _run(self, expand: Expand) -> None:
        self._outcome = call_handler(expand)
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

    def _timed_out(self) -> None:
        self.give_up()
        self._on_timeout()
