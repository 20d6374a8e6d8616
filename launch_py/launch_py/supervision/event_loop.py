"""The one thread of the supervisor: waits for output, signals and timers.

asyncio would work too, but its import takes 30 ms, and the supervisor needs no more than this.
"""

from __future__ import annotations

import heapq
import itertools
import os
import selectors
import signal
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager

LONGEST_WAIT_S = 3600.0
"""The longest single wait. The kernel does not accept an infinite timeout as a number."""

Callback = Callable[[], object]
"""A callback; its return value is ignored."""


class Timer:
    """A callback that is due at a time, unless cancelled."""

    __slots__ = ("callback", "cancelled", "due_s")

    def __init__(self, due_s: float, callback: Callback) -> None:
        self.due_s = due_s
        self.callback = callback
        self.cancelled = False

    def cancel(self) -> None:
        """Do not call the callback any more."""
        self.cancelled = True


class EventLoop:
    """Calls back when a file is readable, a signal has arrived or a timer is due.

    All callbacks run in the thread that calls `run`. For signals it must be the main thread.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self.clock = clock
        self._selector = selectors.DefaultSelector()
        self._timers: list[tuple[float, int, Timer]] = []
        self._order = itertools.count()

    def add_reader(self, fd: int, callback: Callback) -> None:
        """Call back whenever `fd` is readable."""
        self._selector.register(fd, selectors.EVENT_READ, callback)

    def remove_reader(self, fd: int) -> None:
        """Stop calling back for `fd`."""
        self._selector.unregister(fd)

    def call_later(self, delay_s: float, callback: Callback) -> Timer:
        """Call back once after `delay_s`; timers due at the same time keep their order."""
        timer = Timer(self.clock() + delay_s, callback)
        heapq.heappush(self._timers, (timer.due_s, next(self._order), timer))
        return timer

    def run(self, until: Callable[[], bool]) -> None:
        """Run until `until()` is true; it is checked after each round of callbacks."""
        while not until():
            self._wait()
            self.call_due_timers()

    def call_due_timers(self) -> None:
        """Call back for the timers that are due; `run` does this by itself."""
        now_s = self.clock()
        while self._timers and self._timers[0][0] <= now_s:
            timer = heapq.heappop(self._timers)[2]
            if not timer.cancelled:
                timer.callback()

    def close(self) -> None:
        """Release the selector."""
        self._selector.close()

    def _wait(self) -> None:
        while self._timers and self._timers[0][2].cancelled:
            heapq.heappop(self._timers)
        timeout_s = None
        if self._timers:
            timeout_s = min(max(0.0, self._timers[0][0] - self.clock()), LONGEST_WAIT_S)
        for key, _ in self._selector.select(timeout_s):
            # An earlier callback of this round may have removed this one, and a file that it then
            # opened may have got the same number.
            if self._selector.get_map().get(key.fd) is key:
                key.data()

    @contextmanager
    def signals(self, callbacks: Mapping[signal.Signals, Callback]) -> Iterator[None]:
        """Call back from the loop, not from a signal handler, while the context lasts."""
        readable, writable = os.pipe()
        os.set_blocking(readable, False)
        os.set_blocking(writable, False)

        def deliver() -> None:
            # Handle each signal once: a profiler stops and continues a child many times.
            for number in dict.fromkeys(os.read(readable, 65536)):
                callback = callbacks.get(signal.Signals(number))
                if callback is not None:
                    callback()

        previous_fd = signal.set_wakeup_fd(writable, warn_on_full_buffer=False)
        previous = {number: signal.signal(number, lambda *_: None) for number in callbacks}
        self.add_reader(readable, deliver)
        # The parent process may have blocked these signals. Its mask is restored at the end.
        previous_mask = signal.pthread_sigmask(signal.SIG_UNBLOCK, callbacks)
        try:
            yield
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, previous_mask)
            self.remove_reader(readable)
            for number, handler in previous.items():
                signal.signal(number, handler)
            signal.set_wakeup_fd(previous_fd)
            os.close(readable)
            os.close(writable)
