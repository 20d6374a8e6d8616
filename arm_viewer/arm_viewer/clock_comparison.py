"""Compare simulation time with wall time."""

from collections import deque

from arm_viewer.snapshot import SimulationTime

WINDOW_S = 10.0
FACTOR_WINDOW_S = 2.0
"""The factor uses a shorter window than the lag, so that a pause shows soon."""


class ClockComparison:
    """Recent readings of both clocks; use it from one thread at a time."""

    def __init__(self) -> None:
        self._readings: deque[tuple[float, float]] = deque()

    def add(self, wall_s: float, time_s: float) -> None:
        """Add a reading, with a later wall time than all before.

        If simulation time goes back, the simulation was reset, and the comparison restarts.
        """
        if self._readings and time_s < self._readings[-1][1]:
            self._readings.clear()
        self._readings.append((wall_s, time_s))
        while self._readings[0][0] < wall_s - WINDOW_S:
            self._readings.popleft()

    def clear(self) -> None:
        """Forget all readings."""
        self._readings.clear()

    def result(self) -> SimulationTime | None:
        """Return the real-time factor and lag, or None before the first reading."""
        if not self._readings:
            return None
        last_wall_s, last_s = self._readings[-1]
        first_wall_s, first_s = self._readings[0]
        recent = (r for r in self._readings if r[0] >= last_wall_s - FACTOR_WINDOW_S)
        recent_wall_s, recent_s = next(recent)
        passed_s = last_wall_s - recent_wall_s
        return SimulationTime(
            time_s=last_s,
            factor=(last_s - recent_s) / passed_s if passed_s > 0.0 else 0.0,
            lag_s=max(0.0, (last_wall_s - first_wall_s) - (last_s - first_s)),
            measured_s=last_wall_s - first_wall_s,
        )
