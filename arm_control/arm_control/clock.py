"""Wall time as the pacer sees it, so that a test can hand it another."""

import time
from typing import Protocol


class Clock(Protocol):
    """A clock that only moves forward, whatever happens to the date."""

    def now_s(self) -> float:
        """Return seconds since some fixed moment."""
        ...


class MonotonicClock:
    """The operating system's monotonic clock."""

    # The C function itself: the loop asks several times a tick, and a wrapper triples the cost.
    now_s = staticmethod(time.monotonic)
