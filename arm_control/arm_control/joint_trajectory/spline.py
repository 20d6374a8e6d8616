"""Polynomials through way points: linear, cubic or quintic, as far as the points allow."""

from bisect import bisect_right
from typing import Any

import numpy as np
from numpy.typing import NDArray

from arm_control.joint_trajectory.motion import (
    ACCELERATION,
    EFFORT,
    POSITION,
    RESOLUTION_S,
    ROWS,
    VELOCITY,
)

TERMS = 6
"""Coefficients of a polynomial of degree five."""

Array = NDArray[np.float64]


class Spline:
    """A function of time through motions at given times; immutable, so any thread may sample it.

    Between two points the degree of each joint's polynomial is five where both have velocity and
    acceleration, three where both have velocity, and one otherwise. After the last point it stays
    there, with zero for what that point leaves open.

    Attributes:
        end_s: time of the last point.
    """

    __slots__ = ("_coefficients", "_knots_s", "_last", "end_s")

    def __init__(self, times_s: Array, motions: Array) -> None:
        """Compute the polynomials.

        Args:
            times_s: strictly increasing, shape (m,), m >= 1.
            motions: at these times, shape (m, 4, n); every position is known.
        """
        self._knots_s: list[float] = times_s.tolist()
        self.end_s = self._knots_s[-1]
        self._last = np.nan_to_num(motions[-1])
        self._coefficients = _with_derivatives(
            segment_polynomials(motions[:-1], motions[1:], np.diff(times_s))
        )

    def sample(self, time_s: float) -> NDArray[np.float64]:
        """Return the motion at a time not before the first point, shape (4, n); a new array."""
        # Bisection finds the segment in a fraction of a microsecond, however long the trajectory:
        # there is no cursor that one sample could leave in the way of the next.
        segment = bisect_right(self._knots_s, time_s + RESOLUTION_S) - 1
        if segment >= len(self._coefficients):
            return self._last.copy()
        segment = max(segment, 0)
        t = time_s - self._knots_s[segment]
        t2 = t * t
        t3 = t2 * t
        powers = np.array((1.0, t, t2, t3, t2 * t2, t3 * t2))
        return (powers @ self._coefficients[segment]).reshape(ROWS, -1)


def segment_polynomials(start: Array, end: Array, duration_s: Array) -> NDArray[np.float64]:
    """Return polynomials in the time since `start` that lead from there to `end`.

    The linear one through both positions is the base. Where the velocities at both ends are
    known, what they differ from its slope is added as a cubic that vanishes at both ends; where
    the accelerations are known too, what they differ from that is added as a quintic.

    Args:
        start: motions, shape (m, 4, n).
        end: motions, shape (m, 4, n).
        duration_s: shape (m,).

    Returns:
        Coefficients of position and of effort, lowest power first, shape (m, 2, 6, n).
    """
    duration = duration_s[:, None]
    slope = (end[:, POSITION] - start[:, POSITION]) / duration
    v0, v1 = _where_both(start[:, VELOCITY] - slope, end[:, VELOCITY] - slope)
    c2 = -(2.0 * v0 + v1) / duration
    c3 = (v0 + v1) / duration**2
    has_velocity = np.isfinite(start[:, VELOCITY]) & np.isfinite(end[:, VELOCITY])
    a0, a1 = _where_both(
        start[:, ACCELERATION] - 2.0 * c2,
        end[:, ACCELERATION] - 2.0 * c2 - 6.0 * c3 * duration,
        has_velocity,
    )
    polynomials = np.zeros((len(start), 2, TERMS, start.shape[2]))
    position, effort = polynomials[:, 0], polynomials[:, 1]
    position[:, 0] = start[:, POSITION]
    position[:, 1] = slope + v0
    position[:, 2] = c2 + a0 / 2.0
    position[:, 3] = c3 + (a1 - 3.0 * a0) / (2.0 * duration)
    position[:, 4] = (3.0 * a0 - 2.0 * a1) / (2.0 * duration**2)
    position[:, 5] = (a1 - a0) / (2.0 * duration**3)
    effort[:, 0] = np.nan_to_num(start[:, EFFORT])
    effort[:, 1] = (np.nan_to_num(end[:, EFFORT]) - effort[:, 0]) / duration
    return polynomials


def _where_both(a: Array, b: Array, allowed: Any = True) -> tuple[Array, Array]:
    """Return both where both are known and allowed, zeros elsewhere."""
    known = np.isfinite(a) & np.isfinite(b) & allowed
    return np.where(known, a, 0.0), np.where(known, b, 0.0)


def _with_derivatives(polynomials: Array) -> NDArray[np.float64]:
    """Return coefficients of all four rows of a motion side by side, shape (m, 6, 4 n).

    One product of the powers of time with such a matrix is a whole motion.
    """
    segments, _, _, joints = polynomials.shape
    position = polynomials[:, 0]
    order = np.arange(TERMS)[:, None]
    rows = np.zeros((segments, TERMS, ROWS, joints))
    rows[:, :, POSITION] = position
    rows[:, :-1, VELOCITY] = (order * position)[:, 1:]
    rows[:, :-2, ACCELERATION] = (order * (order - 1) * position)[:, 2:]
    rows[:, :, EFFORT] = polynomials[:, 1]
    return rows.reshape(segments, TERMS, ROWS * joints)
