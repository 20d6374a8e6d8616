"""The one thread that owns the hardware (or the simulation) and the controllers."""

import logging
import threading
from collections import deque
from collections.abc import Callable
from concurrent.futures import Future
from queue import Empty, SimpleQueue
from typing import Any, TypeVar

from arm_control.errors import ArmControlError, LoopStoppedError
from arm_control.loop_priority import LoopPriority
from arm_control.outbox import Outbox
from arm_control.pacer import Pacer

ResultT = TypeVar("ResultT")

logger = logging.getLogger(__name__)


class ControlLoop:
    """Runs ticks at the pacer's deadlines, and between them functions that other threads hand in.

    A function handed in while the loop waits for its next deadline, or while it is paused, runs
    at once. Every public method may be called from any thread.

    Attributes:
        pacer: says when a tick is due.
        outbox: takes what is published on the loop thread.
    """

    def __init__(
        self,
        tick: Callable[[], None],
        pacer: Pacer,
        *,
        on_failure: Callable[[BaseException], None] | None = None,
        priority: LoopPriority | None = None,
        outbox: Outbox | None = None,
    ) -> None:
        """Prepare the thread; `start` starts it.

        Args:
            tick: one cycle; if it raises, the loop ends.
            pacer: says when a tick is due; from now on it belongs to the loop thread.
            on_failure: called on the loop thread with what the tick raised, after it was logged.
            priority: chooses the scheduler of the loop thread; default the ordinary one.
            outbox: where ticks put what they publish; default one of the loop's own.
        """
        self.pacer = pacer
        self.outbox = outbox or Outbox()
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
        """Whether steps are to be done; time stands still otherwise."""
        return bool(self._step_requests)

    @property
    def running(self) -> bool:
        """Whether the thread is alive: started, and neither stopped nor failed."""
        return self._thread.is_alive() and not self._closed

    def start(self, *, paused: bool = False) -> None:
        """Start the thread, with time standing still if asked to."""
        self._paused = paused
        self._thread.start()

    def stop(self) -> None:
        """Let the loop end after the present tick; does not wait, see `join`."""
        self.call(self._stop)

    def join(self, timeout_s: float | None = None) -> bool:
        """Wait until the thread has ended; return whether it has."""
        if self._thread.ident is not None:
            self._thread.join(timeout_s)
        return not self._thread.is_alive()

    def call(self, function: Callable[[], ResultT]) -> "Future[ResultT]":
        """Run a function on the loop thread between two ticks, paused or not.

        Returns:
            Its result, or what it raised; `LoopStoppedError` where the loop runs no more. A
            future that is cancelled in time is skipped. Do not wait for it on the loop thread.
        """
        call = _Call(function)
        self._calls.put(call)
        if self._closed:
            # The loop may have emptied the queue for the last time before this call came.
            self._refuse_calls()
        return call.future

    def pause(self) -> "Future[None]":
        """Let time stand still after the present tick; steps not yet done are dropped."""
        return self.call(self._pause)

    def resume(self) -> "Future[None]":
        """Let time go on; steps not yet done are dropped."""
        return self.call(self._resume)

    def step(self, count: int = 1) -> "Future[int]":
        """Run this many ticks while paused, without pacing.

        Returns:
            The number of ticks done: less than `count` where `pause` or `resume` came between.
            Where it is cancelled, ticks not yet done are dropped.
        """
        request = _StepRequest(count)

        def enqueue() -> None:
            if not self._paused:
                raise ValueError("steps are for a paused loop; pause it first")
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
            # Whatever it is, nobody above this thread would hear of it.
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
            self._tick()
            self.outbox.end_tick()
            request.done += 1
        if request.is_over:
            self.outbox.send()
            self._step_requests.popleft().finish()
        self._serve_calls()

    def _wait_for_call(self, timeout_s: float | None) -> None:
        self.outbox.send()
        try:
            call = self._calls.get(timeout=timeout_s)
        except Empty:
            return
        call.run()

    def _serve_calls(self) -> None:
        # Only what is there now: callers that keep coming must not hold up the tick.
        count = self._calls.qsize()
        if count:
            # Whoever calls finds everything sent, and may destroy what it was sent with.
            self.outbox.send()
        for _ in range(count):
            self._calls.get_nowait().run()

    def _pause(self) -> None:
        self._finish_steps()
        self._paused = True
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
    """A function to run on the loop thread, and where its result goes."""

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
            # It is the caller's: whoever waits for the result gets it, and the loop goes on.
            self.future.set_exception(error)
        except BaseException as error:
            # SystemExit, say: it is to end neither this thread nor that of whoever waits.
            logger.exception("a function handed to the control loop failed")
            self.future.set_exception(
                ArmControlError(
                    f"what the control loop was asked to do raised {type(error).__name__}: {error}"
                )
            )
        else:
            self.future.set_result(result)

    def refuse(self, error: LoopStoppedError) -> None:
        if self.future.set_running_or_notify_cancel():
            self.future.set_exception(error)


class _StepRequest:
    """Ticks asked for while the loop is paused."""

    __slots__ = ("count", "done", "future")

    def __init__(self, count: int) -> None:
        self.count = count
        self.done = 0
        self.future: Future[int] = Future()

    @property
    def is_over(self) -> bool:
        """Whether there is nothing more to do."""
        return self.done == self.count or self.future.cancelled()

    def finish(self) -> None:
        """Tell how many were done, unless nobody wants to know any more."""
        if self.future.set_running_or_notify_cancel():
            self.future.set_result(self.done)

    def fail_with(self, call: "Future[None]") -> None:
        """Pass on why the loop did not take the request."""
        error = call.exception()
        if error is not None and self.future.set_running_or_notify_cancel():
            self.future.set_exception(error)
