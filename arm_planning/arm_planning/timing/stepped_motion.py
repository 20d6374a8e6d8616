"""A trajectory from samples of a motion at equal time steps.

The samples are the control points of a uniform cubic B-spline. Its velocities and accelerations are
weighted means of the samples' first and second differences, and its positions are weighted means of
the samples. So it holds every limit that the differences hold, at every instant, even where the
sampled motion changes its acceleration in a jump. It leaves the motion by at most a step^2 / 6.
A trajectory controller's polynomials of degree five repeat its cubics exactly, and most of its
knots can go without a visible difference.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from arm_planning.errors import InvalidRequestError
from arm_planning.robot.model import PlanningLimits
from arm_planning.timing.driven_spline import ROUNDING, DrivenSpline, bernstein
from arm_planning.trajectory import TimedTrajectory

Array = NDArray[np.float64]

NANOSECOND = 1e-9
"""Steps are whole nanoseconds, so ROS messages have the same times to the bit."""
MAX_STEPS = 500_000
"""Longer motions are refused."""
SMALLEST_STEP_S = 5e-4
LARGEST_STEP_S = 0.02

_SPARE = 5e-4
"""By what part a segment that replaces several may exceed a limit."""


@dataclass(frozen=True, slots=True, eq=False)
class MotionLimits:
    """What a trajectory must hold, for each of n joints.

    Attributes:
        velocity: (n,).
        acceleration: (n,).
        jerk: (n,), infinite where it does not matter.
        closeness: largest distance between the trajectory and the spline, rad or m.
    """

    velocity: Array
    acceleration: Array
    jerk: Array
    closeness: float = 1e-4

    def limits(self) -> list[PlanningLimits]:
        """Return them as the limits of joints that may be anywhere."""
        return [
            PlanningLimits(-np.inf, np.inf, *map(float, each))
            for each in zip(self.velocity, self.acceleration, self.jerk, strict=True)
        ]


def step_for(
    duration_s: float, runs: int, acceleration: float, resample_dt: float, closeness: float
) -> float:
    """Return a time step for a motion.

    It is short against the motion, because the spline takes two steps longer for each run from stop
    to stop, and short enough for the spline to stay within `closeness` of the motion, down to half
    a millisecond.

    Args:
        duration_s: how long the motion takes.
        runs: how many times it starts and stops.
        acceleration: largest acceleration of any joint.
        resample_dt: largest time between points of the trajectory.
        closeness: how far the spline may leave the motion, in rad or m.

    Raises:
        PlanningError: FAILURE: the motion takes too many steps.
    """
    step = min(duration_s / runs / 400.0, LARGEST_STEP_S, math.sqrt(6.0 * closeness / acceleration))
    step = min(max(step, SMALLEST_STEP_S), resample_dt)
    if not duration_s <= MAX_STEPS * step:
        raise InvalidRequestError(
            f"the motion would take {duration_s:.3g} s, but at most {MAX_STEPS * step:.3g} s can "
            "be timed; raise the limits or the scaling factors, or split the path"
        )
    return step


def steps(duration_s: float, step_s: float) -> Array:
    """Return times from 0 to a duration, as many equal steps as cover it, at least one."""
    return np.linspace(0.0, duration_s, max(1, int(np.ceil(duration_s / step_s - 1e-9))) + 1)


def joined(runs: Sequence[Array], jerk_steps: int = 0) -> Array:
    """Return the control points of motions from rest to rest, one after another, (k, n).

    Three equal control points let the spline reach the end of each run exactly, at rest.

    Args:
        runs: samples of each, (k, n); each begins where the one before ends.
        jerk_steps: mean over so many steps, which makes accelerations rise gradually.
    """
    around = 2 + max(0, jerk_steps - 1)
    parts = [np.repeat(runs[0][:1], around, axis=0)]
    for run in runs:
        # The next run repeats the last sample.
        parts += [run, np.repeat(run[-1:], around - 1, axis=0)]
    parts.append(runs[-1][-1:])
    samples = np.concatenate(parts)
    return _running_mean(samples, jerk_steps) if jerk_steps > 1 else samples


def _running_mean(samples: Array, count: int) -> Array:
    # Relative to the first sample, because the sum of many large numbers loses digits.
    sums = np.cumsum(samples - samples[0], axis=0)
    sums = np.concatenate((np.zeros_like(sums[:1]), sums))
    return samples[0] + (sums[count:] - sums[:-count]) / count


def stretch(control: Array, step_s: float, bounds: MotionLimits) -> float:
    """Return the factor by which all times must grow for the limits to hold, at least 1."""
    velocity = np.abs(np.diff(control, axis=0)).max(axis=0) / step_s
    acceleration = np.abs(np.diff(control, 2, axis=0)).max(axis=0) / step_s**2
    jerk = np.abs(np.diff(control, 3, axis=0)).max(axis=0) / step_s**3
    with np.errstate(invalid="ignore"):
        return max(
            1.0,
            float(np.nanmax(velocity / bounds.velocity)),
            float(np.nanmax(acceleration / bounds.acceleration)) ** 0.5,
            float(np.nanmax(jerk / bounds.jerk)) ** (1.0 / 3.0),
        )


def trajectory(
    joints: Sequence[str], control: Array, step_s: float, bounds: MotionLimits, resample_dt: float
) -> TimedTrajectory:
    """Return the trajectory along a spline, slowed down where its limits ask for it.

    Args:
        joints: names, n of them.
        control: control points at equal steps, (k, n), k >= 4.
        step_s: time from one to the next.
        bounds: the limits.
        resample_dt: largest time between points of the trajectory.
    """
    slower = step_s * stretch(control, step_s, bounds)
    step = math.ceil(slower / NANOSECOND - 1e-3) * NANOSECOND
    before, here, after = control[:-2], control[1:-1], control[2:]
    positions = (before + 4.0 * here + after) / 6.0
    velocities = (after - before) / (2.0 * step)
    accelerations = (before - 2.0 * here + after) / step**2
    knots = (positions, velocities, accelerations)
    kept = _kept(knots, step, bounds, max(1, int(resample_dt / step + 1e-9)))
    return TimedTrajectory(
        tuple(joints),
        # Not a product: whole nanoseconds as they are parsed from text.
        np.round(np.flatnonzero(kept).astype(np.float64) * step, 9),
        *(rows[kept] for rows in knots),
    )


def _kept(
    knots: tuple[Array, Array, Array], step_s: float, bounds: MotionLimits, longest: int
) -> NDArray[np.bool_]:
    """Return which knots are needed, (k,): intervals are halved until their polynomials fit."""
    count = len(knots[0])
    kept = np.zeros(count, dtype=np.bool_)
    kept[::longest] = True
    kept[-1] = True
    edges = np.flatnonzero(kept)
    first, last = edges[:-1], edges[1:]
    low, high = knots[0].min(axis=0) - ROUNDING, knots[0].max(axis=0) + ROUNDING
    while len(first):
        middle = (first + last) // 2
        splits = (last - first > 1) & ~_fits(knots, first, middle, last, step_s, bounds, low, high)
        first, middle, last = first[splits], middle[splits], last[splits]
        kept[middle] = True
        first, last = np.concatenate((first, middle)), np.concatenate((middle, last))
    return kept


def _fits(
    knots: tuple[Array, Array, Array],
    first: NDArray[np.intp],
    middle: NDArray[np.intp],
    last: NDArray[np.intp],
    step_s: float,
    bounds: MotionLimits,
    low: Array,
    high: Array,
) -> NDArray[np.bool_]:
    """Return whether the polynomial from one knot to another may replace the spline, (k,)."""
    durations = np.asarray((last - first) * step_s, dtype=np.float64)
    start, end = [rows[first] for rows in knots], [rows[last] for rows in knots]
    spline = DrivenSpline.between(
        durations, (start[0], start[1], start[2]), (end[0], end[1], end[2])
    )
    fits = ((spline.values >= low) & (spline.values <= high)).all(axis=(0, 2))
    for order, limit in ((1, bounds.velocity), (2, bounds.acceleration), (3, bounds.jerk)):
        if np.isfinite(limit).any():
            size = np.abs(spline.derivative(order)).max(axis=0)
            fits &= (size <= limit * (1.0 + _SPARE) + ROUNDING).all(axis=1)
    fraction = (middle - first) / np.maximum(last - first, 1)
    there = np.einsum("ik,ikn->kn", bernstein(5, fraction), spline.values)
    fits &= (np.abs(there - knots[0][middle]) <= bounds.closeness).all(axis=1)
    return fits
