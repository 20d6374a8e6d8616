"""How fast a path can be driven from cell to cell, within limits of velocity and acceleration.

With x the square of the path speed and u the path acceleration, every joint's limits are linear in
(u, x), and x changes linearly along the path while u is constant. So one pass backward finds the
largest x from which the rest of the path can be driven, and one pass forward accelerates as much as
that allows (Pham and Pham, A New Approach to Time-Optimal Path Parameterization Based on
Reachability Analysis, T-RO 2018).
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class ReachableSpeeds:
    """The limits of the path speed in cells of constant path acceleration.

    Attributes:
        top: largest x at the start of each cell, and at the end, (k + 1,).
        slopes, offsets: after the cell x is at most slope * x + offset for each row, (rows, k).
        reach: largest path acceleration at x = 0, (k,).
    """

    top: Array
    slopes: Array
    offsets: Array
    reach: Array

    @classmethod
    def of(
        cls,
        start: tuple[Array, Array],
        end: tuple[Array, Array],
        lengths: Array,
        velocity: Array,
        acceleration: Array,
    ) -> "ReachableSpeeds":
        """Return the limits of cells.

        Args:
            start: first and second derivative of the joints by the path at the start, (n, k) each.
            end: likewise at the end.
            lengths: (k,).
            velocity: limits of the joints, (n, k).
            acceleration: likewise.
        """
        (tangents, bends), (later, later_bends) = start, end
        # |gain * u + load * x| <= room, at the start of the cell and at its end.
        gain = np.concatenate((tangents, later + 2.0 * lengths * later_bends))
        load = np.concatenate((bends, later_bends))
        room = np.concatenate((acceleration, acceleration))
        with np.errstate(divide="ignore", invalid="ignore"):
            reach = np.where(gain != 0.0, room / np.abs(gain), np.inf)
            slope = np.where(gain != 0.0, load / gain, 0.0)
            fast = (velocity / np.maximum(np.abs(tangents), np.abs(later))).min(axis=0) ** 2
        top = np.append(np.minimum(fast, _steepest(gain, load, room)), fast[-1])
        top[1:] = np.minimum(top[1:], fast)
        twice = 2.0 * lengths
        return cls(top, 1.0 - twice * slope, twice * reach, reach.min(axis=0))

    def fastest(self, first: float, last: float) -> Array:
        """Return the largest x at the start of each cell and at the end, (k + 1,).

        Args:
            first: largest x at the start of the path.
            last: likewise at its end.
        """
        with np.errstate(divide="ignore", invalid="ignore"):
            bounded = self.slopes > 0.0
            slopes = np.where(bounded, 1.0 / self.slopes, 0.0)
            offsets = np.where(bounded, self.offsets / self.slopes, np.inf)
        backward = slice(None, None, -1)
        end = min(last, float(self.top[-1]))
        latest = _pass(end, self.top[backward], slopes[:, backward], offsets[:, backward])
        reachable = np.array(latest[backward])
        start = min(first, float(reachable[0]))
        return np.array(_pass(start, reachable, self.slopes, self.offsets))


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


def _pass(x: float, top: Array, slopes: Array, offsets: Array) -> list[float]:
    """Return x before, between and after the cells: min(top, slope * x + offset) from one to next.

    Args:
        x: value before the first.
        top: bound before, between and after the cells, (k + 1,).
        slopes: (rows, k).
        offsets: (rows, k).
    """
    # Each step depends on the one before. Python's own numbers take a fraction of the time that
    # arrays of a dozen elements would, as few rows are left.
    cell, row = np.nonzero(_needed(top, slopes, offsets).T)
    pairs = list(zip(slopes[row, cell].tolist(), offsets[row, cell].tolist(), strict=True))
    ends = np.searchsorted(cell, np.arange(len(top) - 1), side="right").tolist()
    values, begin = [x], 0
    for bound, end in zip(top[1:].tolist(), ends, strict=True):
        for slope, offset in pairs[begin:end]:
            reached = slope * x + offset
            if reached < bound:
                bound = reached
        begin = end
        x = bound if bound > 0.0 else 0.0
        values.append(x)
    return values


def _needed(top: Array, slopes: Array, offsets: Array) -> NDArray[np.bool_]:
    """Return which rows may bound x after a cell, for any x from 0 to the bound before it."""
    at_zero, at_top = offsets, slopes * np.minimum(top[:-1], 1e300) + offsets
    # A line that is above another one at both ends is above it everywhere.
    least = np.expand_dims(at_zero.argmin(axis=0), 0), np.expand_dims(at_top.argmin(axis=0), 0)
    needed = at_top < np.take_along_axis(at_top, least[0], axis=0)
    needed &= at_zero < np.take_along_axis(at_zero, least[1], axis=0)
    for index in least:
        np.put_along_axis(needed, index, True, axis=0)
    return needed & (np.minimum(at_zero, at_top) < top[1:])
