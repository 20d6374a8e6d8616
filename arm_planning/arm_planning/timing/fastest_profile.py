"""The fastest motion along a rounded path within limits of velocity and acceleration.

With x the square of the path speed and u the path acceleration, every joint's limits are linear in
(u, x), and x changes linearly along the path while u is constant. So one pass backward finds the
largest x from which the rest of the path can be driven, and one pass forward accelerates as much as
that allows. This replaces the search for switching points of Kunz and Stilman (RSS 2012), which
breaks down where a joint's share of the direction vanishes; the passes are those of Pham and Pham
(A New Approach to Time-Optimal Path Parameterization Based on Reachability Analysis, T-RO 2018).
On a straight piece the solution is exact: accelerate, cruise, brake.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from arm_planning.timing.rounded_path import Indices, RoundedPath

Array = NDArray[np.float64]

CELL = np.radians(15.0)
"""Largest turn of a cell of an arc, in rad; the path acceleration is constant in a cell."""
FEWEST_CELLS = 300
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
        top: largest x at its start, (k,).
        slopes, offsets: after the cell x is at most slope * x + offset for each row, (rows, k).
        accelerations: largest path acceleration of a straight cell, (k,).
    """

    pieces: Indices
    starts: Array
    lengths: Array
    top: Array
    slopes: Array
    offsets: Array
    accelerations: Array


def fastest(path: RoundedPath, velocity: Array, acceleration: Array) -> TimedPath:
    """Return the fastest motion along a path, from rest to rest.

    Args:
        path: the path; each joint that it moves needs a finite acceleration limit above 0.
        velocity: limits, (n,), above 0.
        acceleration: limits, (n,).
    """
    cells = _cells(path, velocity, acceleration)
    return _timed(path, cells, _squared_speeds(cells))


def _cells(path: RoundedPath, velocity: Array, acceleration: Array) -> _Cells:
    turns = path.lengths * path.curvatures
    cell = min(CELL, max(float(turns.sum()) / FEWEST_CELLS, 1e-6))
    counts = np.ceil(turns / cell).astype(np.intp).clip(min=1)
    pieces = np.repeat(np.arange(len(counts)), counts)
    number = np.arange(len(pieces)) - np.repeat(np.cumsum(counts) - counts, counts)
    lengths = path.lengths[pieces] / counts[pieces]
    starts = number * lengths
    ends = starts + lengths
    tangents, bends = path.tangents(pieces, starts).T, path.bends(pieces, starts).T
    later, later_bends = path.tangents(pieces, ends).T, path.bends(pieces, ends).T
    # Between the ends of a cell a sinusoid bulges by at most this factor.
    bulge = np.cos(0.5 * lengths * path.curvatures[pieces])
    # |gain * u + load * x| <= room, at the start of the cell and at its end.
    gain = np.concatenate((tangents, later + 2.0 * lengths * later_bends))
    load = np.concatenate((bends, later_bends))
    room = np.concatenate((acceleration, acceleration))[:, None] * bulge
    with np.errstate(divide="ignore", invalid="ignore"):
        reach = np.where(gain != 0.0, room / np.abs(gain), np.inf)
        slope = np.where(gain != 0.0, load / gain, 0.0)
        steepest = np.maximum(np.abs(tangents), np.abs(later))
        fast = bulge * (velocity[:, None] / steepest).min(axis=0)
    top = np.minimum(fast**2, _steepest(gain, load, room))
    top[1:] = np.minimum(top[1:], fast[:-1] ** 2)
    twice = 2.0 * lengths
    return _Cells(
        pieces, starts, lengths, top, 1.0 - twice * slope, twice * reach, reach.min(axis=0)
    )


def _steepest(gain: Array, load: Array, room: Array) -> Array:
    """Return the largest x for which some u satisfies |gain u + load x| <= room, (k,).

    Eliminating u from each pair of rows leaves a bound of x (Fourier and Motzkin).
    """
    top = np.full(gain.shape[1], np.inf)
    bent = np.flatnonzero(load.any(axis=0))
    if not len(bent):
        return top
    gain, load, room = gain[:, bent], load[:, bent], room[:, bent]
    size = np.abs(gain)
    with np.errstate(divide="ignore", invalid="ignore"):
        least = np.where((gain == 0.0) & (load != 0.0), room / np.abs(load), np.inf).min(axis=0)
        for row in range(len(gain) - 1):
            others = slice(row + 1, None)
            crossed = np.abs(load[row] * gain[others] - load[others] * gain[row])
            free = room[row] * size[others] + room[others] * size[row]
            # 0 / 0 is a pair of rows without u, each of which is its own bound.
            least = np.fmin(least, np.fmin.reduce(free / crossed, axis=0))
    top[bent] = least
    return top


def _squared_speeds(cells: _Cells) -> Array:
    """Return the square of the path speed at the start of each cell and at the end, (k + 1,)."""
    with np.errstate(divide="ignore", invalid="ignore"):
        bounded = cells.slopes > 0.0
        slopes = np.where(bounded, 1.0 / cells.slopes, 0.0)
        offsets = np.where(bounded, cells.offsets / cells.slopes, np.inf)
        least = cells.offsets + np.minimum(cells.slopes, 0.0) * cells.top
    latest = _pass(0.0, cells.top[::-1], slopes[:, ::-1], offsets[:, ::-1], offsets[:, ::-1])
    return np.array(_pass(0.0, np.array(latest[-2::-1]), cells.slopes, cells.offsets, least))


def _pass(x: float, top: Array, slopes: Array, offsets: Array, least: Array) -> list[float]:
    """Return x before, between and after the cells: min(top, slope * x + offset) from one to next.

    Args:
        x: value before the first.
        top: bound after each cell, (k,).
        slopes: (rows, k).
        offsets: (rows, k).
        least: lower bound of slope * x + offset, (rows, k): rows above the top are left out.
    """
    # Each step depends on the one before. Python's own numbers take a fraction of the time that
    # arrays of a dozen elements would.
    cell, row = np.nonzero((least < top).T)
    pairs = list(zip(slopes[row, cell].tolist(), offsets[row, cell].tolist(), strict=True))
    ends = np.searchsorted(cell, np.arange(len(top)), side="right").tolist()
    values, begin = [x], 0
    for bound, end in zip(top.tolist(), ends, strict=True):
        for slope, offset in pairs[begin:end]:
            reached = slope * x + offset
            if reached < bound:
                bound = reached
        begin = end
        x = bound if bound > 0.0 else 0.0
        values.append(x)
    return values


def _timed(path: RoundedPath, cells: _Cells, squared: Array) -> TimedPath:
    """Return when the path is where; a straight cell becomes up to three stretches."""
    before, after = squared[:-1], squared[1:]
    straight = path.curvatures[cells.pieces] == 0.0
    steep = 2.0 * np.where(straight, cells.accelerations, 1.0)
    peak = np.minimum(cells.top, 0.5 * (before + after + steep * cells.lengths))
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
