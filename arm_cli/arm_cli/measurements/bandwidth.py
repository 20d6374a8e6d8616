"""The bandwidth of messages over a window."""

from collections import deque


class BandwidthWindow:
    """Arrival times and sizes of the last messages."""

    def __init__(self, size: int) -> None:
        """Keep at most `size` messages."""
        self._messages: deque[tuple[float, int]] = deque(maxlen=size)

    def add(self, now_s: float, size: int) -> None:
        """Take a message of some bytes that came at a time."""
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
