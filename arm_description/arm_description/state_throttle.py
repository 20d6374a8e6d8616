"""Which joint states are passed on: at most so many a second, counted by their own stamps."""

from collections.abc import Sequence

LONGEST_INTERVAL_MS = 1e13
"""Longer than any stamp: at a frequency too low for a division nothing is passed on."""


class StateThrottle:
    """Admits a joint state when its stamp lies one interval after those of its joints before.

    The rule is robot_state_publisher's: the oldest of the joints that a message names decides, so
    two publishers of different joints do not throttle each other, and a stamp that does not
    advance is never admitted. One thread at a time.
    """

    def __init__(self, frequency_hz: float) -> None:
        """Throttle to a frequency; 0 admits every stamp that is not older than the last."""
        self._interval_ns = 0
        self._published_ns: dict[str, int] = {}
        self._now_ns = 0
        self.set_frequency(frequency_hz)

    def set_frequency(self, frequency_hz: float) -> None:
        """Set the highest frequency; takes effect with the next message."""
        # Whole milliseconds, as upstream: 30 Hz in, 30 Hz out, in spite of jitter below 0.3 ms.
        interval_ms = min(1000.0 / frequency_hz, LONGEST_INTERVAL_MS) if frequency_hz else 0.0
        self._interval_ns = int(interval_ms) * 1_000_000

    def went_back(self, now_ns: int) -> bool:
        """Note the node's time; return whether it went back, in which case all is forgotten."""
        back = now_ns < self._now_ns
        if back:
            self._published_ns.clear()
        self._now_ns = now_ns
        return back

    def due(self, names: Sequence[str], stamp_ns: int) -> bool:
        """Return whether a message with this stamp about these joints is to be passed on."""
        oldest = self._now_ns
        for name in names:
            oldest = min(oldest, self._published_ns.get(name, 0))
        return stamp_ns >= oldest + self._interval_ns

    def passed_on(self, names: Sequence[str], stamp_ns: int) -> None:
        """Remember that a message was passed on."""
        self._published_ns.update(dict.fromkeys(names, stamp_ns))
