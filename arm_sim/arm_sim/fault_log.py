"""Records which faults occurred, and when."""

import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass


@dataclass(slots=True)
class FaultSpan:
    """A span of time with a fault.

    Attributes:
        name: the fault's name in reports.
        began_s: when it began, in simulation time.
        ended_s: when it ended; inf while it lasts.
    """

    name: str
    began_s: float
    ended_s: float = math.inf

    def __str__(self) -> str:
        until = "" if self.ended_s == math.inf else f" to {self.ended_s:.3f} s"
        return f"fault: {self.name}, from {self.began_s:.3f} s{until}"


class FaultLog:
    """Records the faults of a test. One thread.

    Args:
        now_s: returns the simulation time.

    Attributes:
        spans: the faults so far, in the order in which they began.
    """

    def __init__(self, now_s: Callable[[], float]) -> None:
        self.spans: list[FaultSpan] = []
        self._now_s = now_s

    @contextmanager
    def noted(self, name: str) -> Iterator[None]:
        """Record a fault that lasts as long as the `with` block."""
        span = FaultSpan(name, self._now_s())
        self.spans.append(span)
        try:
            yield
        finally:
            span.ended_s = self._now_s()

    def restart(self) -> None:
        """Forget the faults that have ended; those that still last count from now on."""
        self.spans = [span for span in self.spans if span.ended_s == math.inf]
        for span in self.spans:
            span.began_s = self._now_s()
