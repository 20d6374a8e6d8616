"""A curve's samples from its begin to now, in a bounded space and with every peak.

Of the older samples only the smallest and the largest of each short span are left. A NaN between
two samples is a gap in the curve, and stays one.
"""

import threading
from collections.abc import Collection, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

CAPACITY = 131_072
"""Samples of a curve: at 500 Hz a complete minute, and spans of 0.2 s in an hour."""
FIRST_ROOM = 1024
MIN_GAP_S = 0.25
GAP_PERIODS = 4.0
"""A curve has a gap where the next sample is later than this many periods, and than MIN_GAP_S."""

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class CurveSamples:
    """A part of a curve.

    Attributes:
        times: seconds since the epoch (n,), ascending.
        values: (n,); NaN is a gap.
    """

    times: Array
    values: Array


def thinned(samples: CurveSamples, spans: int) -> CurveSamples:
    """Return the smallest and the largest value of each span of time, and the gaps between them.

    Args:
        samples: at least one.
        spans: number of spans of equal length.

    Returns:
        At most 2 * spans samples, all of them from `samples`, and at most one NaN more than those.
    """
    times, values = samples.times, samples.values
    real = np.flatnonzero(~np.isnan(values))
    kept = real
    if len(real) > 2 * spans:
        length = (times[-1] - times[0]) or 1.0
        span = np.minimum((times[real] - times[0]) * (spans / length), spans - 1).astype(np.intp)
        order = np.lexsort((values[real], span))
        ends = np.flatnonzero(np.diff(span[order], append=spans))
        begins = np.concatenate(([0], ends[:-1] + 1))
        kept = np.unique(real[order[np.concatenate((begins, ends))]])
    is_gap = np.isnan(values)
    before = np.cumsum(is_gap)
    # Of the NaN between two kept samples the first.
    passed = np.concatenate(([0], before[kept], [before[-1]]))
    gaps = np.flatnonzero(is_gap)[passed[:-1][np.diff(passed) > 0]]
    index = np.sort(np.concatenate((kept, gaps)))
    return CurveSamples(times[index], values[index])


class History:
    """The samples of one curve; use it from one thread at a time."""

    def __init__(self, capacity: int = CAPACITY) -> None:
        """Keep at most `capacity` samples."""
        self._capacity = capacity
        self._times = np.empty(min(FIRST_ROOM, capacity))
        self._values = np.empty_like(self._times)
        self._count = 0

    def append(self, times: Array, values: Array) -> None:
        """Add samples (n,), not earlier than those before; an infinity counts as NaN."""
        for begin in range(0, len(times), max(1, self._capacity // 4)):
            end = begin + max(1, self._capacity // 4)
            self._append(times[begin:end], values[begin:end])

    def since(self, time_s: float) -> CurveSamples:
        """Return a copy of the samples later than a time."""
        begin = int(np.searchsorted(self._times[: self._count], time_s, side="right"))
        kept = slice(begin, self._count)
        return CurveSamples(self._times[kept].copy(), self._values[kept].copy())

    def _append(self, times: Array, values: Array) -> None:
        count = len(times)
        while self._count + count > len(self._times):
            self._make_room()
        new = slice(self._count, self._count + count)
        # Two publishers of a topic may overtake each other. What follows `since` is later than it.
        earliest = np.nextafter(self._times[self._count - 1], np.inf) if self._count else -np.inf
        self._times[new] = np.maximum.accumulate(np.maximum(times, earliest))
        self._values[new] = np.where(np.isfinite(values), values, np.nan)
        self._count += count

    def _make_room(self) -> None:
        if len(self._times) < self._capacity:
            size = min(2 * len(self._times), self._capacity)
            self._times = np.resize(self._times, size)
            self._values = np.resize(self._values, size)
            return
        # With a gap beside every sample, half of them are left.
        old = slice(0, 3 * self._count // 4)
        left = thinned(CurveSamples(self._times[old], self._values[old]), self._capacity // 8)
        recent = slice(old.stop, self._count)
        count = len(left.times) + self._count - old.stop
        self._times[:count] = np.concatenate((left.times, self._times[recent]))
        self._values[:count] = np.concatenate((left.values, self._values[recent]))
        self._count = count


class Curves:
    """The histories of named curves. Any thread may use it.

    Whoever has samples appends them, live or from a file; the page sends its browsers what is new.
    """

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._histories: dict[str, History] = {}

    def append(self, times: Array, columns: Mapping[str, Array]) -> None:
        """Add samples of curves: ascending times since the epoch (n,), and values (n,) by curve."""
        with self._lock:
            for name, values in columns.items():
                history = self._histories.get(name)
                if history is None:
                    history = self._histories[name] = History()
                history.append(times, values)

    def since(self, name: str, time_s: float) -> CurveSamples:
        """Return a copy of the samples later than a time; none if the curve is unknown."""
        with self._lock:
            history = self._histories.get(name)
            return history.since(time_s) if history else CurveSamples(np.empty(0), np.empty(0))

    def keep(self, names: Collection[str]) -> None:
        """Forget all other curves."""
        with self._lock:
            for name in self._histories.keys() - set(names):
                del self._histories[name]


class GapFinder:
    """Finds the gaps of one topic, whose period it learns."""

    def __init__(self) -> None:
        self._last_s = np.nan
        self._period_s = np.nan

    def with_gaps(self, times: Array, columns: Array) -> tuple[Array, Array]:
        """Return times (m,) and columns (k, m) with a NaN in each gap.

        Args:
            times: of the samples since the last call (n,), ascending, at least one.
            columns: their values (k, n).
        """
        intervals = np.diff(times, prepend=self._last_s)
        self._last_s = float(times[-1])
        known = intervals[~np.isnan(intervals)]
        if not len(known):
            return times, columns
        longest_s = max(MIN_GAP_S, GAP_PERIODS * self._period_s)
        if np.isnan(self._period_s):
            longest_s = np.inf
        self._learn(float(np.median(known)))
        at = np.flatnonzero(intervals > longest_s)
        middles = times[at] - intervals[at] / 2.0
        return np.insert(times, at, middles), np.insert(columns, at, np.nan, axis=1)

    def _learn(self, period_s: float) -> None:
        """Follow a period that changes, without much regard to a single one."""
        if np.isnan(self._period_s):
            self._period_s = period_s
        self._period_s += 0.5 * (min(period_s, 4.0 * self._period_s) - self._period_s)
