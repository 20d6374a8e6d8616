"""The part of a trajectory that is still ahead."""

import numpy as np

from arm_planning.timing.driven_spline import DrivenSpline
from arm_planning.trajectory import TimedTrajectory

SHORTEST_S = 1e-6
"""A point ahead that is nearer than this is left out."""


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


def _rows(trajectory: TimedTrajectory) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    return trajectory.positions, trajectory.velocities, trajectory.accelerations
