"""Straight ways of a link, point by point by inverse kinematics."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from arm_controller.errors import PlanError
from arm_controller.way import Way, WayPoint
from arm_description.inverse_kinematics import InverseKinematics

Array = NDArray[np.float64]

POINTS_PER_S = 10
LARGEST_STEP = 0.3
"""Between two points, rad or m; a joint that has to go further swings round a singular pose."""


def straight_way(
    kinematics: InverseKinematics, start: Sequence[float], target: Array, duration_s: float
) -> Way:
    """Return the way on which a link goes straight to a pose, without turning.

    Args:
        kinematics: of the link.
        start: positions of the joints at the start, shape (n,).
        target: the link's pose at the end, turned as at the start, (4, 4).
        duration_s: how long it takes, by the least jerk.

    Raises:
        KinematicsError: a place on the way is out of reach.
        PlanError: the link would have to go fast round a singular pose.
    """
    count = max(2, round(duration_s * POINTS_PER_S))
    times = np.linspace(0.0, 1.0, count + 1)
    shares = times**3 * (10.0 + times * (6.0 * times - 15.0))
    pose = kinematics.pose(start)
    along = target[:3, 3] - pose[:3, 3]
    joints = [np.asarray(start, dtype=float)]
    for share in shares[1:]:
        place = target.copy()
        place[:3, 3] = pose[:3, 3] + share * along
        joints.append(kinematics.solve(place, joints[-1]))
    if np.abs(np.diff(joints, axis=0)).max() > LARGEST_STEP:
        raise PlanError("a joint would have to swing round on the straight way")
    velocities = np.gradient(np.array(joints), duration_s / count, axis=0)
    velocities[-1] = 0.0
    return tuple(
        WayPoint(float(time * duration_s), tuple(q.tolist()), tuple(v.tolist()))
        for time, q, v in zip(times[1:], joints[1:], velocities[1:], strict=True)
    )
