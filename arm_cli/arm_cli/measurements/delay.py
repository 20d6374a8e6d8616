"""The age of messages' stamps on arrival, over a window."""

import math
from collections import deque


class DelayWindow:
    """Ages of the last messages in ns.

    Attributes:
        taken: messages so far.
    """

    def __init__(self, size: int) -> None:
        """Keep at most `size` messages."""
        self.taken = 0
        self._delays_ns: deque[int] = deque(maxlen=size)

    def add(self, delay_ns: int) -> None:
        """Take a message of some age."""
        self.taken += 1
        self._delays_ns.append(delay_ns)

    def describe(self) -> str | None:
        """Return the two lines that ros2 prints, None before the first message."""
        delays = self._delays_ns
        if not delays:
            return None
        count = len(delays)
        mean = sum(delays) / count
        deviation = math.sqrt(sum((x - mean) ** 2 for x in delays) / count)
        return (
            f"average delay: {mean * 1e-9:.3f}\n"
            f"\tmin: {min(delays) * 1e-9:.3f}s max: {max(delays) * 1e-9:.3f}s "
            f"std dev: {deviation * 1e-9:.5f}s window: {count}"
        )
