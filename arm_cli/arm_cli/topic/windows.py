"""Windows that measure the rate, the bandwidth and the delay of the last messages."""

import math
from collections import deque
from collections.abc import Collection


class RateWindow:
    """The intervals between the last messages.

    Times are in ns of any clock. A jump back in time resets the window.

    Attributes:
        taken: the number of messages so far.
    """

    def __init__(self, size: int) -> None:
        """Keep at most `size` intervals."""
        self.taken = 0
        self._intervals_ns: deque[int] = deque(maxlen=size)
        self._last_ns: int | None = None

    def add(self, now_ns: int) -> None:
        """Add a message that arrived at a time."""
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
        mean = sum(intervals) / len(intervals)
        rate = 1e9 / mean if mean > 0 else 0.0
        return f"average rate: {rate:.3f}\n{_spread(intervals)}"


class BandwidthWindow:
    """The arrival times and sizes of the last messages."""

    def __init__(self, size: int) -> None:
        """Keep at most `size` messages."""
        self._messages: deque[tuple[float, int]] = deque(maxlen=size)

    def add(self, now_s: float, size: int) -> None:
        """Add a message of `size` bytes that arrived at a time."""
        self._messages.append((now_s, size))

    def describe(self, now_s: float) -> str | None:
        """Return the two lines that ros2 prints, None before the second message."""
        if len(self._messages) < 2 or now_s <= self._messages[0][0]:
            return None
        sizes = [size for _, size in self._messages]
        per_second = sum(sizes) / (now_s - self._messages[0][0])
        divisor, digits, unit = _unit(per_second)
        rate, mean, low, high = (
            f"{value / divisor:.{digits}f} {unit}"
            for value in (per_second, sum(sizes) / len(sizes), min(sizes), max(sizes))
        )
        return (
            f"{rate}/s from {len(sizes)} messages\n"
            f"\tMessage size mean: {mean} min: {low} max: {high}"
        )


def _unit(per_second: float) -> tuple[int, int, str]:
    if per_second < 1000:
        return 1, 0, "B"
    return (1000, 2, "KB") if per_second < 1_000_000 else (1_000_000, 2, "MB")


class DelayWindow:
    """The ages of the last messages in ns.

    Attributes:
        taken: the number of messages so far.
    """

    def __init__(self, size: int) -> None:
        """Keep at most `size` messages."""
        self.taken = 0
        self._delays_ns: deque[int] = deque(maxlen=size)

    def add(self, delay_ns: int) -> None:
        """Add a message of some age."""
        self.taken += 1
        self._delays_ns.append(delay_ns)

    def describe(self) -> str | None:
        """Return the two lines that ros2 prints, None before the first message."""
        delays = self._delays_ns
        if not delays:
            return None
        return f"average delay: {sum(delays) / len(delays) * 1e-9:.3f}\n{_spread(delays)}"


def _spread(durations_ns: Collection[int]) -> str:
    """Return the second line that ros2 prints for rates and delays."""
    count = len(durations_ns)
    mean = sum(durations_ns) / count
    deviation = math.sqrt(sum((x - mean) ** 2 for x in durations_ns) / count)
    return (
        f"\tmin: {min(durations_ns) * 1e-9:.3f}s max: {max(durations_ns) * 1e-9:.3f}s "
        f"std dev: {deviation * 1e-9:.5f}s window: {count}"
    )
