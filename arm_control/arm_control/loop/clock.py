"""The clocks of the control loop, and a throttle. Tests pass a `ManualClock` instead."""

import time
from typing import Protocol


class Clock(Protocol):
    """A clock. The pacer needs one that never goes back."""

    def now_s(self) -> float:
        """Return seconds since a fixed moment."""
        ...


class MonotonicClock:
    """The operating system's monotonic clock."""

    # The C function itself: the loop calls it several times a tick, and a wrapper triples the cost.
    now_s = staticmethod(time.monotonic)


class SystemClock:
    """The system time, ROS's time outside a simulation; it may be set back."""

    now_s = staticmethod(time.time)


class Throttle:
    """Permits one event per interval of wall time. One thread at a time."""

    def __init__(self, interval_s: float, clock: Clock | None = None) -> None:
        self._interval_s = interval_s
        self._now_s = (clock or MonotonicClock()).now_s
        self._next_s = float("-inf")

    def permits(self) -> bool:
        """Return whether the interval since the last permission is over; if so, start a new one."""
        now_s = self._now_s()
        if now_s < self._next_s:
            return False
        self._next_s = now_s + self._interval_s
        return True
