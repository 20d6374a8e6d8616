"""Fills in what a trajectory leaves open: joints that it does not name, quantities to integrate."""

import numpy as np
from numpy.typing import NDArray

from arm_control.joint_trajectory.motion import ACCELERATION, POSITION, VELOCITY

Array = NDArray[np.float64]


def hold_joints(motions: Array, held: NDArray[np.bool_], position: Array) -> NDArray[np.float64]:
    """Return way points in which some joints stand still.

    Args:
        motions: way points, shape (m, 4, n).
        held: which joints stand, shape (n,); at least one does not.
        position: where, shape (n,); only that of the held ones counts.
    """
    motions = motions.copy()
    # A held joint has zeros where the others have numbers, so that it does not lower the degree.
    leader = int(np.argmin(held))
    motions[:, :, held] = np.where(np.isnan(motions[:, :, leader]), np.nan, 0.0)[:, :, None]
    motions[:, POSITION, held] = position[held]
    return motions


def integrate(times_s: Array, motions: Array, start: Array) -> NDArray[np.float64]:
    """Return way points whose positions are all known.

    A missing position comes from the trapezoid of the velocities here and at the point before; a
    velocity missing as well from that of the accelerations. What a point is integrated from
    counts as zero where it is missing.

    Args:
        times_s: of the way points, counted from the start, shape (m,).
        motions: way points, shape (m, 4, n).
        start: motion before the first one, shape (4, n); its position is known.
    """
    chain = np.concatenate([start[None], motions])
    # There is no way from the start to a first point in the past.
    halves = np.diff(times_s, prepend=min(0.0, times_s[0]))[:, None] / 2.0
    position, velocity, acceleration = (chain[:, row] for row in (POSITION, VELOCITY, ACCELERATION))
    open_position = np.isnan(position)
    open_velocity = open_position & np.isnan(velocity)
    acceleration[_and_before(open_velocity) & np.isnan(acceleration)] = 0.0
    velocity[_and_before(open_position) & ~open_velocity & np.isnan(velocity)] = 0.0
    velocity[:] = _accumulate(velocity, acceleration, halves, open_velocity)
    position[:] = _accumulate(position, velocity, halves, open_position)
    return chain[1:]


def _and_before(rows: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Return the same rows, and each row before one of them."""
    wider = rows.copy()
    wider[:-1] |= rows[1:]
    return wider


def _accumulate(
    values: Array, rates: Array, halves: Array, is_open: NDArray[np.bool_]
) -> NDArray[np.float64]:
    """Return values, shape (m + 1, n), where each open one is the one before plus its trapezoid."""
    steps = np.where(is_open[1:], (rates[:-1] + rates[1:]) * halves, 0.0)
    total = np.concatenate([np.zeros_like(values[:1]), np.cumsum(steps, axis=0)])
    rows = np.arange(len(values))[:, None]
    given = np.maximum.accumulate(np.where(is_open, 0, rows), axis=0)
    anchored = np.take_along_axis(values - total, given, axis=0)
    return np.where(is_open, anchored + total, values)
