"""The fastest motion along a rounded path within limits of velocity and acceleration.

`reachable_speeds` replaces the search for switching points of Kunz and Stilman (RSS 2012), which
breaks down where a joint's share of the direction vanishes. On a straight piece the solution is
exact: accelerate, cruise, brake.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from arm_planning.timing.reachable_speeds import ReachableSpeeds
from arm_planning.timing.rounded_path import Indices, RoundedPath

Array = NDArray[np.float64]

CELL = np.radians(18.0)
"""Largest turn of a cell of an arc, in rad; the path acceleration is constant in a cell."""
FEWEST_CELLS = 150
"""Arcs of a path of few pieces are divided into smaller cells, about so many in all."""


@dataclass(frozen=True, slots=True, eq=False)
class TimedPath:
    """When a motion is where on its path.

    Stretches of constant path acceleration follow one another.

    Attributes:
        path: the path.
        pieces: piece of the path of each stretch, (k,).
        alongs: where each begins, from the start of its piece, (k,).
        speeds: path speed there, (k,).
        accelerations: path acceleration, (k,).
        times_s: when each begins, (k,).
        duration_s: when the last ends.
    """

    path: RoundedPath
    pieces: Indices
    alongs: Array
    speeds: Array
    accelerations: Array
    times_s: Array
    duration_s: float

    def positions(self, times_s: Array) -> Array:
        """Return the joint positions at some times, (k, n)."""
        stretch = np.searchsorted(self.times_s, times_s, side="right") - 1
        since = times_s - self.times_s[stretch]
        moved = (self.speeds[stretch] + 0.5 * self.accelerations[stretch] * since) * since
        piece = self.pieces[stretch]
        along = np.clip(self.alongs[stretch] + moved, 0.0, self.path.lengths[piece])
        return self.path.positions(piece, along)


@dataclass(frozen=True, slots=True, eq=False)
class _Cells:
    """The cells of a path: whole straight pieces, and parts of arcs.

    Attributes:
        pieces: piece of each cell, (k,).
        starts: where it begins, from the start of its piece, (k,).
        lengths: (k,).
        limits: how fast they can be driven.
    """

    pieces: Indices
    starts: Array
    lengths: Array
    limits: ReachableSpeeds


def fastest(path: RoundedPath, velocity: Array, acceleration: Array) -> TimedPath:
    """Return the fastest motion along a path, from rest to rest.

    Args:
        path: the path; each joint that it moves needs a finite acceleration limit above 0.
        velocity: limits, (n,), above 0.
        acceleration: limits, (n,).
    """
    cells = _cells(path, velocity, acceleration)
    return _timed(path, cells, cells.limits.fastest(0.0, 0.0))


def _cells(path: RoundedPath, velocity: Array, acceleration: Array) -> _Cells:
    turns = path.lengths * path.curvatures
    cell = min(CELL, max(float(turns.sum()) / FEWEST_CELLS, 1e-6))
    counts = np.ceil(turns / cell).astype(np.intp).clip(min=1)
    pieces = np.repeat(np.arange(len(counts)), counts)
    number = np.arange(len(pieces)) - np.repeat(np.cumsum(counts) - counts, counts)
    lengths = path.lengths[pieces] / counts[pieces]
    starts = number * lengths
    ends = starts + lengths
    # Between the ends of a cell a sinusoid bulges by at most this factor.
    bulge = np.cos(0.5 * lengths * path.curvatures[pieces])
    limits = ReachableSpeeds.of(
        (path.tangents(pieces, starts).T, path.bends(pieces, starts).T),
        (path.tangents(pieces, ends).T, path.bends(pieces, ends).T),
        lengths,
        velocity[:, None] * bulge,
        acceleration[:, None] * bulge,
    )
    return _Cells(pieces, starts, lengths, limits)


def _timed(path: RoundedPath, cells: _Cells, squared: Array) -> TimedPath:
    """Return when the path is where; a straight cell becomes up to three stretches."""
    before, after = squared[:-1], squared[1:]
    straight = path.curvatures[cells.pieces] == 0.0
    steep = 2.0 * np.where(straight, cells.limits.reach, 1.0)
    peak = np.minimum(cells.limits.top[:-1], 0.5 * (before + after + steep * cells.lengths))
    peak = np.maximum(peak, np.maximum(before, after))
    rise, fall = (peak - before) / steep, (peak - after) / steep
    parts = np.zeros((len(before), 3))
    parts[:, 0] = np.where(straight, np.minimum(rise, cells.lengths), cells.lengths)
    parts[:, 2] = np.where(straight, np.minimum(fall, cells.lengths - parts[:, 0]), 0.0)
    parts[:, 1] = np.where(straight, cells.lengths - parts[:, 0] - parts[:, 2], 0.0)
    ends = np.cumsum(parts, axis=1)
    alongs = cells.starts[:, None] + ends - parts
    at_start = np.stack((before, peak, peak), axis=1)
    at_end = np.stack((np.where(straight, peak, after), peak, after), axis=1)
    exists = parts.ravel() > 1e-15
    lengths, begin, finish = (
        parts.ravel()[exists],
        np.sqrt(at_start.ravel()[exists]),
        np.sqrt(at_end.ravel()[exists]),
    )
    durations = 2.0 * lengths / (begin + finish)
    times = np.concatenate(([0.0], np.cumsum(durations)))
    return TimedPath(
        path,
        np.repeat(cells.pieces, 3)[exists],
        alongs.ravel()[exists],
        begin,
        (finish - begin) / durations,
        times[:-1],
        float(times[-1]),
    )
