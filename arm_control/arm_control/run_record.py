"""How often something ran of late, and how long each run took."""

from collections import deque
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

_MICROSECONDS = 1e6


@dataclass(frozen=True, slots=True)
class Spread:
    """What a set of samples looks like, all in the unit of the samples."""

    mean: float
    standard_deviation: float
    minimum: float
    maximum: float


@dataclass(frozen=True, slots=True)
class RunStatistics:
    """The latest runs in figures.

    Attributes:
        periodicity_hz: how often they came; None where there were not two in a row.
        execution_time_us: how long they took.
    """

    periodicity_hz: Spread | None
    execution_time_us: Spread


class RunRecord:
    """The latest runs of a controller, a component or the whole loop.

    One thread adds, at a cost of a fifth of a microsecond and without anything that grows; any
    other thread may ask for the statistics at any time.
    """

    __slots__ = ("_durations_s", "_periods_s")

    def __init__(self, size: int) -> None:
        """Keep this many runs."""
        self._periods_s: deque[float] = deque(maxlen=size)
        self._durations_s: deque[float] = deque(maxlen=size)

    def add(self, period_s: float, duration_s: float) -> None:
        """Note a run.

        Args:
            period_s: from the start of the run before; where it is not positive, or NaN, nothing
                is known of it.
            duration_s: wall time that it took.
        """
        self._periods_s.append(period_s)
        self._durations_s.append(duration_s)

    def clear(self) -> None:
        """Forget all runs. The adding thread."""
        self._periods_s.clear()
        self._durations_s.clear()

    def statistics(self) -> RunStatistics | None:
        """Return the runs so far in figures, None where there was none; any thread."""
        # A deque is copied in one step of the interpreter, so the other thread is never half-way.
        durations_s = np.array(self._durations_s.copy())
        periods_s = np.array(self._periods_s.copy())
        if not durations_s.size:
            return None
        return RunStatistics(_rate(periods_s), _spread(durations_s * _MICROSECONDS))


def _spread(samples: NDArray[np.float64]) -> Spread:
    return Spread(
        float(samples.mean()), float(samples.std()), float(samples.min()), float(samples.max())
    )


def _rate(periods_s: NDArray[np.float64]) -> Spread | None:
    """Return rates in Hz: one over the mean period, not the mean of one over each.

    The latter would let two runs in quick succession, as they make up for a late one, outweigh
    all the others. The deviation is that of the periods, carried over to first order.
    """
    # NaN before the first run, not positive where the clock has stood still.
    periods_s = periods_s[periods_s > 0.0]
    if not periods_s.size:
        return None
    mean_hz = 1.0 / float(periods_s.mean())
    return Spread(
        mean_hz,
        float(periods_s.std()) * mean_hz**2,
        1.0 / float(periods_s.max()),
        1.0 / float(periods_s.min()),
    )
