"""Decides in which cycles of a loop something with a lower rate is due.

A `Schedule` is for events, such as a message or a picture; a `Cadence` for something that runs in
whole cycles and needs their period.
"""

import logging
import math
from math import nan

logger = logging.getLogger("controller_manager")

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

        `start_s` is the time of event 0; None for the time of the first cycle after the start.
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


class Cadence:
    """Selects the cycles of a loop that best match a lower rate. Loop thread only.

    Attributes:
        rate_hz: the lower rate.
        skips: whether some cycles are not due; if not, nobody needs to ask `due_period_s`.
    """

    def __init__(self, rate_hz: int, cycle_rate_hz: int) -> None:
        """Make a cadence whose first cycle is due; for `rate_hz` see `achievable_rate_hz`."""
        self.rate_hz = rate_hz
        self.skips = rate_hz < cycle_rate_hz
        self._own_period_s = 1.0 / rate_hz
        self._last_s = nan
        self._elapsed_s = 0.0

    def restart(self) -> None:
        """Start again: the next cycle is due, with the nominal period."""
        self._last_s = nan

    def save_state(self) -> tuple[float, float]:
        """Return the state, for `load_state`."""
        return self._last_s, self._elapsed_s

    def load_state(self, state: tuple[float, float]) -> None:
        """Continue from a saved state."""
        self._last_s, self._elapsed_s = state

    def due_period_s(self, time_s: float, cycle_s: float) -> float | None:
        """Return the period to run with; None if a later cycle comes closer to the lower rate.

        After the clock is set back, the next cycle is a first one. Setting it forward makes no
        cycle due earlier. `cycle_s` is the time from the last cycle to this one.
        """
        if not self.skips:
            return cycle_s
        # Sums the cycles instead of subtracting times, because the clock may have been set.
        self._elapsed_s += cycle_s
        if time_s >= self._last_s:
            error_s = abs(self._elapsed_s - self._own_period_s)
            if error_s > abs(self._elapsed_s + cycle_s - self._own_period_s):
                return None
        else:
            self._elapsed_s = self._own_period_s
        elapsed_s, self._elapsed_s = self._elapsed_s, 0.0
        self._last_s = time_s
        return elapsed_s


def achievable_rate_hz(owner: str, requested_hz: int, cycle_rate_hz: int) -> int:
    """Return the divisor of the loop's rate nearest to a requested rate; log a difference.

    `owner` is what runs at the rate, such as "controller 'arm'"; a request of 0 is for the loop's.
    """
    if requested_hz > cycle_rate_hz:
        logger.warning(
            "%s asks for %d Hz; it runs at the controller manager's %d Hz",
            owner,
            requested_hz,
            cycle_rate_hz,
        )
    if not 0 < requested_hz < cycle_rate_hz:
        return cycle_rate_hz
    rate_hz = cycle_rate_hz // round(cycle_rate_hz / requested_hz)
    if rate_hz != requested_hz:
        logger.warning(
            "%s asks for %d Hz, which does not divide the controller manager's %d Hz; "
            "it runs at %d Hz",
            owner,
            requested_hz,
            cycle_rate_hz,
            rate_hz,
        )
    return rate_hz
