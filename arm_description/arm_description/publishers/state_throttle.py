"""Limits the rate at which joint states are used, by their stamps."""

from collections.abc import Sequence

MAX_INTERVAL_MS = 1e13
"""Longer than any stamp, so that at an extremely low frequency no joint state is used."""


class StateThrottle:
    """Accepts a joint state if its stamp is one interval after the last ones of its joints.

    As in robot_state_publisher, the joint with the oldest stamp decides, so two publishers of
    different joints do not throttle each other. A stamp that does not advance is never accepted.
    One thread at a time.
    """

    def __init__(self, frequency_hz: float) -> None:
        """Throttle to a frequency; 0 accepts every stamp that is not older than the last."""
        self._interval_ns = 0
        self._published_ns: dict[str, int] = {}
        self._now_ns = 0
        self.set_frequency(frequency_hz)

    def set_frequency(self, frequency_hz: float) -> None:
        """Set the maximum frequency; it takes effect with the next message."""
        # Whole milliseconds as in ROS 2: 30 Hz in, 30 Hz out, despite jitter below 0.3 ms.
        interval_ms = min(1000.0 / frequency_hz, MAX_INTERVAL_MS) if frequency_hz else 0.0
        self._interval_ns = int(interval_ms) * 1_000_000

    def went_back(self, now_ns: int) -> bool:
        """Record the node's time; return whether it went back, which resets the throttle."""
        back = now_ns < self._now_ns
        if back:
            self._published_ns.clear()
        self._now_ns = now_ns
        return back

    def due(self, names: Sequence[str], stamp_ns: int) -> bool:
        """Return whether to use a message with this stamp about these joints."""
        oldest = self._now_ns
        for name in names:
            oldest = min(oldest, self._published_ns.get(name, 0))
        return stamp_ns >= oldest + self._interval_ns

    def record_used(self, names: Sequence[str], stamp_ns: int) -> None:
        """Record that a message was used."""
        self._published_ns.update(dict.fromkeys(names, stamp_ns))
