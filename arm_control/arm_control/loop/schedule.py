"""Decides in which cycles an event with its own rate is due, such as a message or a picture.

Use a `Cadence` for something that runs in whole cycles at a lower rate and needs their period.
"""

import math

TOLERANCE_S = 1e-6
"""Rounding error of a time that is a sum of steps."""


class Schedule:
    """Event k is due in the first cycle at or after k periods from the start. One thread.

    The mean rate is exact at any rate of the cycles. In a cycle that passes several events, only
    the last one is due. When time goes back, the schedule starts again.

    Attributes:
        number: k of the last event that was due; -1 before the first one.
        next_s: the time of the next event.
    """

    __slots__ = ("_is_fixed", "_last_s", "_rate_hz", "_start_s", "next_s", "number")

    def __init__(self, rate_hz: float, start_s: float | None = None) -> None:
        """Make a schedule whose first event is due in the first cycle.

        Args:
            rate_hz: events per second.
            start_s: the time of event 0; None for the time of the first cycle after the start.
        """
        self._rate_hz = rate_hz
        self._is_fixed = start_s is not None
        self._start_s = start_s or 0.0
        self.restart()

    def restart(self) -> None:
        """Start again: the next cycle is the first one."""
        self.number = -1
        self.next_s = -math.inf
        self._last_s = math.inf

    def save_state(self) -> tuple[float, ...]:
        """Return the state, for `load_state`."""
        return self._start_s, self._last_s, self.next_s, self.number

    def load_state(self, state: tuple[float, float, float, int]) -> None:
        """Continue from a saved state."""
        self._start_s, self._last_s, self.next_s, self.number = state

    def is_due(self, time_s: float) -> bool:
        """Return whether an event is due in the cycle at this time; call it once per cycle."""
        if self._last_s <= time_s < self.next_s:
            self._last_s = time_s
            return False
        if time_s < self._last_s:
            self.number = -1
            if not self._is_fixed:
                self._start_s = time_s
        self._last_s = time_s
        number = math.floor((time_s - self._start_s + TOLERANCE_S) * self._rate_hz)
        is_due = number > self.number
        self.number = max(number, self.number)
        self.next_s = self._start_s + (self.number + 1) / self._rate_hz - TOLERANCE_S
        return is_due
