"""Motions of several joints, and profiles: the motion at each time from now on.

A motion is the position, velocity, acceleration and effort of each joint, shape (4, n).
"""

from bisect import bisect_right
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from arm_control.controllers.angles import nearest_turn
from arm_control.state.encoding import StateValue

POSITION, VELOCITY, ACCELERATION, EFFORT = range(4)
ROWS = 4

QUANTITIES = ("position", "velocity", "acceleration", "effort")
"""Interface names of the rows."""

RESOLUTION_S = 1e-9
"""Times closer than this are equal: it is the resolution of ROS times."""

LARGEST = 1e15
"""Upper bound of a client's numbers: beyond it, a float64 cannot resolve one radian, and
polynomials could overflow."""

TERMS = 6
"""Coefficients of a polynomial of degree five."""

SLICE = 500
"""How many segments are computed at a time. More would not fit the processor's cache, and would
make other threads wait for the interpreter."""

Array = NDArray[np.float64]


def at_rest(position: Array) -> Array:
    """Return the motion of joints at rest at `position`, shape (n,), without effort."""
    motion = np.zeros((ROWS, len(position)))
    motion[POSITION] = position
    return motion


def completed(motion: Array, other: Array) -> Array:
    """Return a motion whose unknown positions come from another one."""
    known = np.isfinite(motion[POSITION])
    if known.all():
        return motion
    filled = motion.copy()
    filled[POSITION] = np.where(known, motion[POSITION], other[POSITION])
    return filled


class Spline(StateValue):
    """A piecewise polynomial through motions; immutable, so any thread may sample it.

    Between two points the degree of each joint's polynomial is five if both have velocity and
    acceleration, three if both have velocity, and one otherwise. After the last point it stays
    there; values that the point does not give are 0.

    Attributes:
        end_s: time of the last point.
    """

    __slots__ = ("_coefficients", "_knots_s", "_last", "end_s")

    def __init__(self, times_s: Array, motions: Array) -> None:
        """Compute the polynomials.

        The times (m,) increase strictly, m >= 1; every position in the motions (m, 4, n) is known.
        """
        self._knots_s: list[float] = times_s.tolist()
        self.end_s = self._knots_s[-1]
        self._last = np.nan_to_num(motions[-1])
        segments, joints = len(motions) - 1, motions.shape[2]
        self._coefficients = np.empty((segments, TERMS, ROWS * joints))
        for first in range(0, segments, SLICE):
            end = min(first + SLICE, segments)
            self._coefficients[first:end] = _with_derivatives(
                segment_polynomials(
                    motions[first:end],
                    motions[first + 1 : end + 1],
                    np.diff(times_s[first : end + 1]),
                )
            )

    def sample(self, time_s: float) -> Array:
        """Return the motion at a time not before the first point, shape (4, n); a new array."""
        # Bisection finds the segment in a fraction of a microsecond, however long the trajectory,
        # and needs no state between samples.
        segment = bisect_right(self._knots_s, time_s + RESOLUTION_S) - 1
        if segment >= len(self._coefficients):
            return self._last.copy()
        segment = max(segment, 0)
        t = time_s - self._knots_s[segment]
        t2 = t * t
        t3 = t2 * t
        powers = np.array((1.0, t, t2, t3, t2 * t2, t3 * t2))
        return (powers @ self._coefficients[segment]).reshape(ROWS, -1)


def segment_polynomials(start: Array, end: Array, duration_s: Array) -> Array:
    """Return polynomials in the time since `start` that lead from `start` to `end`.

    The base is linear through both positions. If the velocities at both ends are known, their
    difference from its slope is added as a cubic that vanishes at both ends; if the accelerations
    are known too, their difference from the result is added as a quintic. The motions have the
    shape (m, 4, n), the durations (m,).

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
    """Return both values where both are known and allowed, zeros elsewhere."""
    known = np.isfinite(a) & np.isfinite(b) & allowed
    return np.where(known, a, 0.0), np.where(known, b, 0.0)


def _with_derivatives(polynomials: Array) -> Array:
    """Return coefficients of all four rows of a motion side by side, shape (m, 6, 4 n).

    The product of the powers of time with such a matrix is a complete motion.
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


class MotionProfile(Protocol):
    """A function of time."""

    @property
    def end_s(self) -> float:
        """When the last point is reached; at most 0 if there is no motion."""
        ...

    def sample(self, time_s: float) -> Array:
        """Return the motion at a time not before 0, shape (4, n); nothing in it is NaN."""
        ...


class SplineProfile(StateValue):
    """Moves from a start to the first waypoint, then along a spline through all of them.

    The motion to the first point is a polynomial whose degree depends on the point; values that the
    start does not give count as 0. A first point in the past is skipped.
    """

    __slots__ = ("_lead_end_s", "_lead_in", "_offset_s", "_spline", "end_s")

    def __init__(
        self, start: Array, first: Array, spline: Spline, first_s: float, offset_s: float
    ) -> None:
        """Make a profile that leads to a spline.

        Args:
            start: motion at time 0, shape (4, n).
            first: motion at the spline's first point, shape (4, n).
            spline: spline through all waypoints.
            first_s: time of the first point in the spline's time.
            offset_s: this profile's time at the spline's time 0.
        """
        self._spline = spline
        self._offset_s = offset_s
        self._lead_end_s = offset_s + first_s
        self._lead_in = None
        if self._lead_end_s > RESOLUTION_S:
            ends = np.stack([np.nan_to_num(start), first])
            self._lead_in = Spline(np.array([0.0, self._lead_end_s]), ends)
        self.end_s = offset_s + spline.end_s

    def sample(self, time_s: float) -> Array:
        """Return the motion at a time."""
        if self._lead_in is not None and time_s + RESOLUTION_S < self._lead_end_s:
            return self._lead_in.sample(time_s)
        return self._spline.sample(time_s - self._offset_s)


class StepProfile(StateValue):
    """Steps to each waypoint at the time of the previous one."""

    __slots__ = ("_motions", "_times_s", "end_s")

    def __init__(self, start: Array, motions: Array, times_s: Array) -> None:
        """Make a profile that stays at `start` until the first of `motions`, (m, 4, n), is due."""
        self._motions = np.nan_to_num(np.concatenate([start[None], motions, motions[-1:]]))
        self._times_s: list[float] = times_s.tolist()
        self.end_s = self._times_s[-1]

    def sample(self, time_s: float) -> Array:
        """Return the motion at a time."""
        due = bisect_right(self._times_s, time_s + RESOLUTION_S)
        return self._motions[due + 1 if due else 0].copy()


class StopProfile(StateValue):
    """Brings each joint to rest with its deceleration, and keeps it there.

    A joint stops after the time |v| / a and the distance v |v| / (2 a).
    """

    __slots__ = ("_deceleration", "_position", "_rest", "_stop_s", "_velocity", "end_s")

    def __init__(self, position: Array, velocity: Array, deceleration: Array) -> None:
        """Make a profile that stops; all shapes are (n,), and the deceleration is positive."""
        self._position = position
        self._velocity = velocity
        self._deceleration = np.copysign(deceleration, velocity)
        self._stop_s = velocity / self._deceleration
        self.end_s = float(self._stop_s.max(initial=0.0))
        self._rest = at_rest(position + 0.5 * velocity * self._stop_s)

    @classmethod
    def hold(cls, position: Array) -> "StopProfile":
        """Return a profile that holds a position."""
        return cls(position.copy(), np.zeros_like(position), np.ones_like(position))

    def sample(self, time_s: float) -> Array:
        """Return the motion at a time."""
        if time_s >= self.end_s:
            return self._rest.copy()
        t = np.minimum(self._stop_s, time_s)
        motion = np.zeros((ROWS, len(t)))
        motion[POSITION] = self._position + t * (self._velocity - 0.5 * t * self._deceleration)
        motion[VELOCITY] = self._velocity - t * self._deceleration
        motion[ACCELERATION] = np.where(time_s < self._stop_s, -self._deceleration, 0.0)
        return motion


class JoinedProfile(StateValue):
    """Joins a spline without a step in position, velocity or acceleration.

    Before its first point, the spline is extrapolated backwards with that point's velocity. The
    difference between the current command and the spline is added to the spline, and fades to 0
    along a quintic until the time of the first point, or more slowly if that is too soon.
    """

    __slots__ = ("_difference", "_first", "_lead_end_s", "_offset_s", "_spline", "end_s")

    def __init__(
        self,
        commanded: Array,
        spline: Spline,
        first_s: float,
        offset_s: float,
        least_s: float,
        continuous: NDArray[np.bool_],
    ) -> None:
        """Join a spline.

        Args:
            commanded: motion at time 0, shape (4, n).
            spline: spline through all waypoints.
            first_s: time of the first point in the spline's time.
            offset_s: this profile's time at the spline's time 0.
            least_s: minimum time in which the difference fades; the profile ends no sooner.
            continuous: which joints are continuous, shape (n,): they take the shortest rotation.
        """
        self._spline = spline
        self._offset_s = offset_s
        self._lead_end_s = offset_s + first_s
        self._first = spline.sample(first_s)
        self._first[ACCELERATION] = 0.0
        ahead = spline.sample(max(first_s, -offset_s))
        start = commanded.copy()
        start[POSITION] = nearest_turn(start[POSITION], ahead[POSITION], continuous)
        difference = start - self._wanted(0.0)
        fade_s = max(least_s, self._lead_end_s)
        self._difference = Spline(
            np.array([0.0, fade_s]), np.stack([difference, np.zeros_like(difference)])
        )
        end_s = offset_s + spline.end_s
        self.end_s = max(end_s, fade_s) if difference.any() else end_s

    def sample(self, time_s: float) -> Array:
        """Return the motion at a time."""
        return self._wanted(time_s) + self._difference.sample(time_s)

    def _wanted(self, time_s: float) -> Array:
        lead_s = self._lead_end_s - time_s
        if lead_s <= RESOLUTION_S:
            return self._spline.sample(time_s - self._offset_s)
        motion = self._first.copy()
        motion[POSITION] -= lead_s * motion[VELOCITY]
        return motion
