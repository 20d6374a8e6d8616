"""The one thread that owns the hardware (or the simulation) and the controllers."""

import logging
import threading
from collections import deque
from collections.abc import Callable
from concurrent.futures import Future
from math import inf
from queue import Empty, SimpleQueue
from typing import Any, TypeVar

from arm_control.errors import ArmControlError, LoopStoppedError
from arm_control.loop.lock_step import LockStep
from arm_control.loop.outbox import Outbox
from arm_control.loop.pacer import Pacer
from arm_control.loop.priority import LoopPriority

ResultT = TypeVar("ResultT")

logger = logging.getLogger("controller_manager")


class ControlLoop:
    """Runs ticks at the pacer's deadlines and, between them, functions from other threads.

    A function that arrives while the loop waits for its next deadline, or while it is paused, runs
    immediately. Every public method may be called from any thread.

    Attributes:
        pacer: decides when a tick is due.
        outbox: collects what is published on the loop thread.
        lock_step: waits for partners before each tick; None for no partners.
    """

    def __init__(
        self,
        tick: Callable[[], None],
        pacer: Pacer,
        *,
        on_failure: Callable[[BaseException], None] | None = None,
        priority: LoopPriority | None = None,
        outbox: Outbox | None = None,
        lock_step: LockStep | None = None,
    ) -> None:
        """Prepare the thread; `start` starts it.

        Args:
            tick: one cycle; if it raises, the loop ends.
            pacer: decides when a tick is due; the loop thread owns it from now on.
            on_failure: called on the loop thread with what the tick raised, after it is logged.
            priority: chooses the scheduler of the loop thread; default the ordinary one.
            outbox: collects what ticks publish; by default the loop makes one.
            lock_step: delays each tick until the partners have answered the previous one; at the
                end of each tick, its owner passes the time to it.
        """
        self.pacer = pacer
        self.outbox = outbox or Outbox()
        self.lock_step = lock_step
        self._tick = tick
        self._on_failure = on_failure
        self._priority = priority or LoopPriority(0)
        self._calls: SimpleQueue[_Call] = SimpleQueue()
        self._step_requests: deque[_StepRequest] = deque()
        self._paused = False
        self._stopping = False
        self._closed = False
        self._thread = threading.Thread(target=self._run, name="control loop", daemon=True)

    @property
    def paused(self) -> bool:
        """Whether time stands still."""
        return self._paused

    @property
    def stepping(self) -> bool:
        """Whether a paused loop still has requested steps to run."""
        return bool(self._step_requests)

    @property
    def running(self) -> bool:
        """Whether the thread is alive: started, and neither stopped nor failed."""
        return self._thread.is_alive() and not self._closed

    @property
    def is_this_thread(self) -> bool:
        """Whether the caller runs on the loop's thread."""
        return threading.get_ident() == self._thread.ident

    def start(self, *, paused: bool = False) -> None:
        """Start the thread, optionally paused."""
        self._paused = paused
        self._thread.start()

    def stop(self) -> None:
        """Make the loop end after the current tick; does not wait, see `join`."""
        self.call(self._stop)

    def join(self, timeout_s: float | None = None) -> bool:
        """Wait until the thread has ended; return whether it has."""
        if self._thread.ident is not None:
            self._thread.join(timeout_s)
        return not self._thread.is_alive()

    def call(self, function: Callable[[], ResultT]) -> "Future[ResultT]":
        """Run a function on the loop thread between two ticks, paused or not.

        Returns:
            Its result or exception; `LoopStoppedError` if the loop has ended. A function whose
            future is cancelled in time does not run. Do not wait for it on the loop thread.
        """
        call = _Call(function)
        self._calls.put(call)
        if self._closed:
            # The loop may have emptied the queue for the last time before this call was added.
            self._refuse_calls()
        return call.future

    def wake(self) -> None:
        """Make a waiting loop check again whether it may go on; cheaper than a call."""
        self._calls.put(_WAKE)

    def pause(self) -> "Future[None]":
        """Pause after the current tick; requested steps that have not run are dropped."""
        return self.call(self._pause)

    def resume(self) -> "Future[None]":
        """Resume; requested steps that have not run are dropped."""
        return self.call(self._resume)

    def step(self, count: int = 1) -> "Future[int]":
        """Run this many ticks while paused, without pacing.

        Returns:
            The number of ticks that ran: less than `count` if `pause` or `resume` interrupted
            them. Cancelling it drops the ticks that have not run.
        """
        request = _StepRequest(count)

        def enqueue() -> None:
            if not self._paused:
                raise ValueError("only a paused loop can be stepped; pause it first")
            if count < 1:
                raise ValueError(f"the number of steps must be positive, not {count}")
            self._step_requests.append(request)

        self.call(enqueue).add_done_callback(request.fail_with)
        return request.future

    def _run(self) -> None:
        try:
            self._priority.lower()
            self.pacer.restart()
            self._loop()
        except BaseException as error:
            # Nothing above this thread would report it.
            logger.exception("the control loop ends: a tick failed")
            self._close()
            if self._on_failure is not None:
                self._on_failure(error)
        else:
            self._close()

    def _loop(self) -> None:
        pacer = self.pacer
        while not self._stopping:
            if self._paused:
                self._idle()
                continue
            if self.lock_step is not None and not self._partners_are_ready(self.lock_step):
                continue
            remaining_s = pacer.remaining_s()
            if remaining_s > 0.0:
                self._wait_for_call(remaining_s)
                continue
            self._serve_calls()
            pacer.begin()
            self._tick()
            self.outbox.end_tick()
            pacer.end()
            self._priority.note(pacer.period_s, pacer.wall_period_s)

    def _idle(self) -> None:
        if not self._step_requests:
            self._wait_for_call(None)
            return
        request = self._step_requests[0]
        if not request.is_over:
            if self.lock_step is not None and not self._partners_are_ready(self.lock_step):
                return
            self._tick()
            self.outbox.end_tick()
            request.done += 1
        if request.is_over:
            self.outbox.send()
            self._step_requests.popleft().finish()
        self._serve_calls()

    def _partners_are_ready(self, lock_step: LockStep) -> bool:
        """Return whether a tick may run; otherwise wait for a call, or pause after the time-out."""
        if lock_step.is_open():
            return True
        remaining_s = lock_step.remaining_s()
        if remaining_s > 0.0:
            self._wait_for_call(None if remaining_s == inf else remaining_s)
        else:
            lock_step.give_up()
            self._pause()
        return False

    def _wait_for_call(self, timeout_s: float | None) -> None:
        self.outbox.send()
        try:
            call = self._calls.get(timeout=timeout_s)
        except Empty:
            return
        call.run()

    def _serve_calls(self) -> None:
        # Only the calls that are queued now: a steady stream of calls must not delay the tick.
        count = self._calls.qsize()
        if count:
            # A call may destroy publishers, so all collected messages go out first.
            self.outbox.send()
        for _ in range(count):
            self._calls.get_nowait().run()

    def _pause(self) -> None:
        self._finish_steps()
        self._paused = True
        if self.lock_step is not None:
            self.lock_step.pause_timeout()
        self._priority.lower()

    def _resume(self) -> None:
        self._finish_steps()
        if self._paused:
            self._paused = False
            self.pacer.restart()
            self._priority.lower()

    def _stop(self) -> None:
        self._stopping = True

    def _close(self) -> None:
        self._closed = True
        self._finish_steps()
        self._refuse_calls()

    def _finish_steps(self) -> None:
        while self._step_requests:
            self._step_requests.popleft().finish()

    def _refuse_calls(self) -> None:
        error = LoopStoppedError("the control loop has ended")
        while True:
            try:
                call = self._calls.get_nowait()
            except Empty:
                return
            call.refuse(error)


class _Call:
    """A function to run on the loop thread, and the future for its result."""

    __slots__ = ("_function", "future")

    def __init__(self, function: Callable[[], Any]) -> None:
        self._function = function
        self.future: Future[Any] = Future()

    def run(self) -> None:
        if not self.future.set_running_or_notify_cancel():
            return
        try:
            result = self._function()
        except Exception as error:
            # The caller gets the exception through the future; the loop goes on.
            self.future.set_exception(error)
        except BaseException as error:
            # For example SystemExit, which must not end this thread or the caller's.
            logger.exception("a function on the control loop failed")
            self.future.set_exception(
                ArmControlError(
                    f"a function on the control loop raised {type(error).__name__}: {error}"
                )
            )
        else:
            self.future.set_result(result)

    def refuse(self, error: LoopStoppedError) -> None:
        if self.future.set_running_or_notify_cancel():
            self.future.set_exception(error)


class _Wake(_Call):
    """A reusable call that only ends a wait."""

    def __init__(self) -> None:
        super().__init__(lambda: None)

    def run(self) -> None:
        pass

    def refuse(self, error: LoopStoppedError) -> None:
        pass


_WAKE = _Wake()


class _StepRequest:
    """A request to run ticks while the loop is paused."""

    __slots__ = ("count", "done", "future")

    def __init__(self, count: int) -> None:
        self.count = count
        self.done = 0
        self.future: Future[int] = Future()

    @property
    def is_over(self) -> bool:
        """Whether all ticks have run, or the request is cancelled."""
        return self.done == self.count or self.future.cancelled()

    def finish(self) -> None:
        """Report how many ticks ran, unless the request is cancelled."""
        if self.future.set_running_or_notify_cancel():
            self.future.set_result(self.done)

    def fail_with(self, call: "Future[None]") -> None:
        """Pass on why the loop refused the request."""
        error = call.exception()
        if error is not None and self.future.set_running_or_notify_cancel():
            self.future.set_exception(error)
