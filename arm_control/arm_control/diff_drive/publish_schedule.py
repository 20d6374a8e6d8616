"""Says in which cycles to publish."""

TOLERANCE = 1e-6
"""Of a period: what rounding adds to or takes from a time."""


class PublishSchedule:
    """Publication k is due in the first cycle at or after k periods: the rate does not drift."""

    def __init__(self, rate_hz: float) -> None:
        """Begin with the next cycle."""
        self._period_s = 1.0 / rate_hz
        self._next_s = float("-inf")

    def is_due(self, time_s: float) -> bool:
        """Return whether to publish in the cycle of this time."""
        if time_s < self._next_s - self._period_s * TOLERANCE:
            # A clock that was set back must not make it silent until it has caught up.
            if time_s > self._next_s - 2 * self._period_s:
                return False
            self._next_s = time_s
        late = time_s - self._next_s > self._period_s
        self._next_s = (time_s if late else self._next_s) + self._period_s
        return True
