"""A motion that is slowed down where its joints could not follow.

The motion itself is the path, and its time the path parameter: the fastest drive along it that is
nowhere faster than the motion.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from arm_planning.timing.reachable_speeds import ReachableSpeeds

Array = NDArray[np.float64]

CELL_S = 0.01
"""Length of the cells in which the motion is looked at."""
FEWEST_CELLS, MOST_CELLS = 100, 5000


@dataclass(frozen=True, slots=True, eq=False)
class SlowedMotion:
    """When a motion is driven.

    Attributes:
        motion: joint positions at times of the motion, (k,) to (k, n).
        begins: start of each cell in the motion's time, (k,).
        rates: how fast its time passes there, at most 1, (k,).
        changes: how fast that changes, per s, (k,).
        times_s: when each cell begins, (k,).
        duration_s: when the last ends.
    """

    motion: Callable[[Array], Array]
    begins: Array
    rates: Array
    changes: Array
    times_s: Array
    duration_s: float

    def positions(self, times_s: Array) -> Array:
        """Return the joint positions at some times, (k, n)."""
        cell = np.searchsorted(self.times_s, times_s, side="right") - 1
        since = times_s - self.times_s[cell]
        passed = (self.rates[cell] + 0.5 * self.changes[cell] * since) * since
        return self.motion(self.begins[cell] + np.clip(passed, 0.0, self.begins[1]))


def slowed(
    motion: Callable[[Array], Array], duration_s: float, velocity: Array, acceleration: Array
) -> SlowedMotion:
    """Return a motion within limits, no faster than it was.

    Peaks shorter than a cell are not seen.

    Args:
        motion: joint positions at times from 0 to the duration, (k,) to (k, n); rests at both ends.
        duration_s: above 0.
        velocity: limits, (n,).
        acceleration: limits, (n,).
    """
    count = min(max(math.ceil(duration_s / CELL_S), FEWEST_CELLS), MOST_CELLS)
    length = duration_s / count
    states = motion(np.linspace(0.0, duration_s, 3 * count + 1))
    tangents: Array = np.gradient(states, length / 3.0, axis=0)[::3].T
    # Two within each cell, so none mixes the accelerations of neighbouring cells.
    bends: Array = np.diff(states, 2, axis=0).T / (length / 3.0) ** 2
    limits = ReachableSpeeds.of(
        (tangents[:, :-1], bends[:, ::3]),
        (tangents[:, 1:], bends[:, 1::3]),
        np.full(count, length),
        np.repeat(velocity[:, None], count, axis=1),
        np.repeat(acceleration[:, None], count, axis=1),
    )
    limits = ReachableSpeeds(
        np.minimum(limits.top, 1.0), limits.slopes, limits.offsets, limits.reach
    )
    rates = np.sqrt(limits.fastest(1.0, 1.0))
    durations = 2.0 * length / (rates[:-1] + rates[1:])
    times = np.concatenate(([0.0], np.cumsum(durations)))
    return SlowedMotion(
        motion,
        length * np.arange(count, dtype=np.float64),
        rates[:-1],
        np.diff(rates) / durations,
        times[:-1],
        float(times[-1]),
    )
