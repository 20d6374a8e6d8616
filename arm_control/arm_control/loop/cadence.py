"""Selects the cycles of a loop in which something with a lower rate runs."""

import logging
from math import nan

logger = logging.getLogger("controller_manager")


class Cadence:
    """Selects the cycles of a loop that best match a lower rate. Loop thread only.

    Attributes:
        rate_hz: the lower rate.
        skips: whether some cycles are not due; if not, nobody needs to ask `due_period_s`.
    """

    def __init__(self, rate_hz: int, cycle_rate_hz: int) -> None:
        """Make a cadence whose first cycle is due.

        Args:
            rate_hz: the lower rate; see `achievable_rate_hz`.
            cycle_rate_hz: the loop's rate.
        """
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
        cycle due earlier.

        Args:
            time_s: of this cycle.
            cycle_s: from the last cycle to this one.
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

    Args:
        owner: what runs at the rate, such as "controller 'arm'".
        requested_hz: the requested rate; 0 for the loop's.
        cycle_rate_hz: the loop's rate.
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
