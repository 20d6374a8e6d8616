"""The rate of messages over a window."""

import math
from collections import deque


class RateWindow:
    """Intervals between the last messages.

    Times are ns of any clock; a clock that goes back starts anew.

    Attributes:
        taken: messages so far.
    """

    def __init__(self, size: int) -> None:
        """Keep at most `size` intervals."""
        self.taken = 0
        self._intervals_ns: deque[int] = deque(maxlen=size)
        self._last_ns: int | None = None

    def add(self, now_ns: int) -> None:
        """Take a message that came at a time."""
        self.taken += 1
        if self._last_ns is not None:
            if now_ns < self._last_ns:
                self._intervals_ns.clear()
            else:
                self._intervals_ns.append(now_ns - self._last_ns)
        self._last_ns = now_ns

    def describe(self) -> str | None:
        """Return the two lines that ros2 prints, None before the second message."""
        intervals = self._intervals_ns
        if not intervals:
            return None
        count = len(intervals)
        mean = sum(intervals) / count
        deviation = math.sqrt(sum((x - mean) ** 2 for x in intervals) / count)
        rate = 1e9 / mean if mean > 0 else 0.0
        return (
            f"average rate: {rate:.3f}\n"
            f"\tmin: {min(intervals) * 1e-9:.3f}s max: {max(intervals) * 1e-9:.3f}s "
            f"std dev: {deviation * 1e-9:.5f}s window: {count}"
        )
