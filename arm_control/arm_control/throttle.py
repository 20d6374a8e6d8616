"""Lets a message through now and then."""

from arm_control.clock import Clock, MonotonicClock


class Throttle:
    """Permits one thing per interval of wall time. One thread at a time."""

    def __init__(self, interval_s: float, clock: Clock | None = None) -> None:
        self._interval_s = interval_s
        self._now_s = (clock or MonotonicClock()).now_s
        self._next_s = float("-inf")

    def permits(self) -> bool:
        """Return whether the interval since the last permission is over; if so, start anew."""
        now_s = self._now_s()
        if now_s < self._next_s:
            return False
        self._next_s = now_s + self._interval_s
        return True
