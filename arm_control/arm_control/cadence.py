"""When something is due that runs at a rate of its own, in the cycles of a faster loop."""

import logging
from math import nan

logger = logging.getLogger(__name__)


class Cadence:
    """Picks the cycles of a loop that come closest to a rate of its own. Loop thread only.

    Attributes:
        rate_hz: how often it picks one.
    """

    def __init__(self, rate_hz: int, cycle_rate_hz: int) -> None:
        """Begin with a first cycle.

        Args:
            rate_hz: the rate of its own; see `possible_rate_hz`.
            cycle_rate_hz: the loop's rate.
        """
        self.rate_hz = rate_hz
        self._own_period_s = 1.0 / rate_hz if rate_hz < cycle_rate_hz else 0.0
        self._last_s = nan
        self._elapsed_s = 0.0

    def restart(self) -> None:
        """Let the next cycle be the first: it is picked, with the nominal period."""
        self._last_s = nan

    def due_period_s(self, time_s: float, cycle_s: float) -> float | None:
        """Return the period to run with, None where a later cycle comes closer to the own period.

        Where time is set back, a first cycle follows; where it is set forward, none comes earlier.

        Args:
            time_s: of this cycle.
            cycle_s: from the last cycle to this one.
        """
        if not self._own_period_s:
            return cycle_s
        # The sum of the cycles, not the difference of times: somebody may have set the clock.
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


def possible_rate_hz(owner: str, requested_hz: int, cycle_rate_hz: int) -> int:
    """Return the rate nearest to the one asked for that divides the loop's, and log what differs.

    Args:
        owner: what is to run: "controller 'arm'".
        requested_hz: the rate asked for; 0 for the loop's.
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
