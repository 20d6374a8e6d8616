"""Time as the pacer and the control cycle see it, so that a test can hand them another."""

import time
from typing import Protocol


class Clock(Protocol):
    """A clock; the pacer's only moves forward, whatever happens to the date."""

    def now_s(self) -> float:
        """Return seconds since some fixed moment."""
        ...


class MonotonicClock:
    """The operating system's monotonic clock."""

    # The C function itself: the loop asks several times a tick, and a wrapper triples the cost.
    now_s = staticmethod(time.monotonic)


class SystemClock:
    """The date: what ROS goes by where no simulation does; may be set back."""

    now_s = staticmethod(time.time)
