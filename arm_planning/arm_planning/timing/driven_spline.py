"""The curve that a joint trajectory controller drives through the points of a trajectory.

Between two points with velocities and accelerations, each joint follows the polynomial of degree
five that meets both. It is kept in Bernstein form: a curve stays between the smallest and the
largest of its control values, so these bound it at every instant, not at samples alone
(G. Farin, Curves and Surfaces for CAGD, section 5.3).
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from math import comb

import numpy as np
from numpy.typing import NDArray

from arm_planning.robot.model import PlanningLimits
from arm_planning.trajectory import TimedTrajectory

Array = NDArray[np.float64]

TOLERANCE = 1e-3
"""By what part a limit may be exceeded."""
ROUNDING = 1e-9
"""By how many rad or m a position limit may be exceeded; by how much per s or s^2 a limit of 0."""
SHORTEST_S = 1e-6
"""A point ahead that is nearer than this is left out."""

_HALVINGS = 2
"""How often a curve is halved before its control values are read: this makes the bounds tight."""
_DEGREE = 5


@dataclass(frozen=True, slots=True, eq=False)
class DrivenSpline:
    """Polynomials of degree five between the points of a trajectory.

    Attributes:
        durations_s: time from each point to the next, (m - 1,).
        values: control values of each segment's positions, (6, m - 1, n).
    """

    durations_s: Array
    values: Array

    @classmethod
    def between(
        cls,
        durations_s: Array,
        start: tuple[Array, Array, Array],
        end: tuple[Array, Array, Array],
    ) -> "DrivenSpline":
        """Return the segments from `start` to `end`.

        Args:
            durations_s: (k,).
            start: positions, velocities and accelerations, (k, n) each.
            end: likewise.
        """
        step = durations_s[:, None] / _DEGREE
        bend = durations_s[:, None] ** 2 / (_DEGREE * (_DEGREE - 1))
        (p0, v0, a0), (p1, v1, a1) = start, end
        first, last = p0 + v0 * step, p1 - v1 * step
        second = 2.0 * first - p0 + a0 * bend
        third = 2.0 * last - p1 + a1 * bend
        return cls(durations_s, np.stack((p0, first, second, third, last, p1)))

    @classmethod
    def of(cls, trajectory: TimedTrajectory) -> "DrivenSpline":
        """Return the curve that a controller drives."""
        p, v, a = _rows(trajectory)
        return cls.between(
            np.diff(trajectory.times_s), (p[:-1], v[:-1], a[:-1]), (p[1:], v[1:], a[1:])
        )

    def derivative(self, order: int) -> Array:
        """Return control values of a derivative by time, (6 - order, m - 1, n)."""
        values = self.values
        for degree in range(_DEGREE, _DEGREE - order, -1):
            values = np.diff(values, axis=0) * (degree / self.durations_s)[:, None]
        return values

    def sample(self, times_s: Array) -> tuple[Array, Array, Array]:
        """Return positions, velocities and accelerations at times from the start, (k, n) each."""
        ends = np.cumsum(self.durations_s)
        segment = np.searchsorted(ends[:-1], times_s, side="right")
        since = times_s - (ends - self.durations_s)[segment]
        fraction = since / self.durations_s[segment]
        rows: list[Array] = []
        for order in range(3):
            values = self.derivative(order)[:, segment]
            weights = bernstein(len(values) - 1, fraction)
            rows.append(np.einsum("ik,ikn->kn", weights, values))
        return rows[0], rows[1], rows[2]

    def positions_in(self, segment: int, fractions: Array) -> Array:
        """Return positions at fractions of the time of one segment, (k, n)."""
        return bernstein(_DEGREE, fractions).T @ self.values[:, segment]

    def largest(self, order: int) -> Array:
        """Return a tight bound of a derivative's size in each segment, (m - 1, n)."""
        return np.abs(halved(self.derivative(order))).max(axis=0)


def halved(values: Array) -> Array:
    """Return the control values of the parts of each curve after it is halved twice.

    Args:
        values: (degree + 1, k, n).

    Returns:
        (4 (degree + 1), k, n).
    """
    # Not a matrix product: BLAS starts threads for large ones, which wait for busy cores.
    return np.einsum("ij,jkn->ikn", _halving(len(values) - 1), values)


def bernstein(degree: int, fraction: Array) -> Array:
    """Return Bernstein's polynomials at fractions of a segment, (degree + 1, k)."""
    rest = 1.0 - fraction
    return np.array(
        [
            comb(degree, power) * fraction**power * rest ** (degree - power)
            for power in range(degree + 1)
        ]
    )


@cache
def _halving(degree: int) -> Array:
    """Return the matrix from control values to those of all parts, by de Casteljau's rule."""
    left = np.array([[comb(i, j) / 2.0**i for j in range(degree + 1)] for i in range(degree + 1)])
    halves = [left, left[::-1, ::-1]]
    parts = [np.eye(degree + 1)]
    for _ in range(_HALVINGS):
        parts = [half @ part for part in parts for half in halves]
    return np.concatenate(parts)


def chord_deviation(trajectory: TimedTrajectory) -> Array:
    """Return how far the driven curve leaves the chords between the points.

    Each state of the curve is compared with the nearest state of its chord, so a segment that is
    straight in joint space has no deviation, however its speed changes. The values are bounds:
    no state of the curve is farther away in any joint.

    Returns:
        The bound for each segment and joint, rad or m, (m - 1, n).
    """
    values = DrivenSpline.of(trajectory).values
    chord = values[-1] - values[0]
    squared = np.einsum("kn,kn->k", chord, chord)
    offset = values - values[0]
    along = np.einsum("ikn,kn->ik", offset, chord)
    along /= np.where(squared > 0.0, squared, 1.0)
    aside = np.abs(halved(offset - along[..., None] * chord)).max(axis=0)
    fraction = halved(along[..., None])[..., 0]
    beyond = np.maximum(fraction.max(axis=0) - 1.0, -fraction.min(axis=0)).clip(min=0.0)
    return aside + beyond[:, None] * np.abs(chord)


def remaining(trajectory: TimedTrajectory, time_s: float) -> TimedTrajectory:
    """Return what a controller has yet to drive; its times start anew.

    A polynomial of degree five is known by its ends, so the curve to the first point ahead is the
    same as in the whole trajectory.

    Args:
        trajectory: the whole, of at least one point.
        time_s: time since its start; before it, everything is ahead; after its end, the last point.
    """
    if time_s <= 0.0:
        return trajectory
    if time_s >= trajectory.duration_s - SHORTEST_S:
        ahead = [rows[-1:] for rows in _rows(trajectory)]
        return TimedTrajectory(trajectory.joints, np.zeros(1), *ahead)
    first = int(np.searchsorted(trajectory.times_s, time_s + SHORTEST_S, side="right"))
    here = DrivenSpline.of(trajectory).sample(np.array([time_s]))
    return TimedTrajectory(
        trajectory.joints,
        np.concatenate(([0.0], trajectory.times_s[first:] - time_s)),
        *(
            np.concatenate((now, rows[first:]))
            for now, rows in zip(here, _rows(trajectory), strict=True)
        ),
    )


def _rows(trajectory: TimedTrajectory) -> tuple[Array, Array, Array]:
    return trajectory.positions, trajectory.velocities, trajectory.accelerations


def limit_violation(
    trajectory: TimedTrajectory,
    limits: Sequence[PlanningLimits],
    *,
    velocity_scaling: float = 1.0,
    acceleration_scaling: float = 1.0,
    with_jerk: bool = False,
) -> str:
    """Return a sentence about where the driven curve breaks a limit, or "" if all limits hold.

    The curve is judged at every instant. Velocity, acceleration and jerk may exceed their limits by
    0.1 %.

    Args:
        trajectory: what is driven.
        limits: the limits of each joint.
        velocity_scaling: fraction of the velocity limits to keep to.
        acceleration_scaling: likewise for the accelerations.
        with_jerk: whether the jerk limits count.
    """
    if len(trajectory.times_s) < 2:
        return ""
    spline = DrivenSpline.of(trajectory)
    lower, upper = (np.array([getattr(each, n) for each in limits]) for n in ("lower", "upper"))
    ranges = [("a position", "", lower, upper, np.zeros(len(limits)))]
    for name, unit, scaling in (
        ("a velocity", "/s", velocity_scaling),
        ("an acceleration", "/s^2", acceleration_scaling),
        ("a jerk", "/s^3", 1.0),
    )[: 3 if with_jerk else 2]:
        bound = scaling * np.array([getattr(limit, name.split()[1]) for limit in limits])
        ranges.append((name, unit, -bound, bound, TOLERANCE * bound))
    for order, (name, unit, low, high, slack) in enumerate(ranges):
        slack = slack + ROUNDING
        found = _beyond(spline.derivative(order), low - slack, high + slack)
        if found is not None:
            segment, joint, value = found
            return (
                f"joint '{trajectory.joints[joint]}' has {name} of {value:.4g} rad or m{unit} "
                f"about {trajectory.times_s[segment]:.3f} s after the start; "
                f"its limits are {low[joint]:.4g} and {high[joint]:.4g}"
            )
    return ""


def _beyond(values: Array, low: Array, high: Array) -> tuple[int, int, float] | None:
    """Return where curves with these control values leave a range most: segment, joint, value."""
    # Few segments are near a limit, so only these are halved.
    near = np.flatnonzero(~((values <= high) & (values >= low)).all(axis=(0, 2)))
    if not len(near):
        return None
    closer = halved(values[:, near])
    excess = np.maximum(closer - high, low - closer)
    if (excess <= 0.0).all():
        return None
    where = int(np.argmax(np.where(np.isnan(excess), np.inf, excess)))
    part, segment, joint = (int(index) for index in np.unravel_index(where, excess.shape))
    return int(near[segment]), joint, float(closer[part, segment, joint])
