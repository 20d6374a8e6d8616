"""Paths of an arm's joints: timed positions, from rest to rest."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from arm_controller.errors import PlanError

if TYPE_CHECKING:
    from arm_description.kinematics.inverse import InverseKinematics


Array = NDArray[np.float64]

POINTS_PER_S = 10
MAX_STEP = 0.3
"""Between two points, rad or m; a larger step means that a joint passes a singularity."""


@dataclass(frozen=True, slots=True)
class PathPoint:
    """Positions (rad or m) and velocities (per second) of the joints at a time.

    Attributes:
        time_s: time since the start of the path.
        positions: shape (n,).
        velocities: shape (n,), or empty: then the joints move at constant speed.
    """

    time_s: float
    positions: tuple[float, ...]
    velocities: tuple[float, ...]


JointPath = tuple[PathPoint, ...]
"""Does not contain the start: an arm starts at its current position."""


def path_to(positions: Sequence[float], duration_s: float) -> JointPath:
    """Return a path from anywhere to these positions, which it reaches at rest."""
    return (PathPoint(duration_s, tuple(positions), (0.0,) * len(positions)),)


def reversed_path(path: JointPath, start: Sequence[float]) -> JointPath:
    """Return a path in reverse; `start` are the positions before its first point."""
    duration_s = path[-1].time_s
    back = [
        PathPoint(duration_s - point.time_s, point.positions, tuple(-v for v in point.velocities))
        for point in reversed(path[:-1])
    ]
    return (*back, *path_to(start, duration_s))


def straight_path(
    kinematics: "InverseKinematics", start: Sequence[float], target: Array, duration_s: float
) -> JointPath:
    """Return the path on which a link moves along a straight line without rotating.

    Args:
        kinematics: inverse kinematics of the link.
        start: positions of the joints at the start, shape (n,).
        target: the link's pose at the end, with the same orientation as at the start, shape (4, 4).
        duration_s: duration of the minimum-jerk motion.

    Raises:
        KinematicsError: a point of the line is out of reach.
        PlanError: the line passes a singularity.
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
    if np.abs(np.diff(joints, axis=0)).max() > MAX_STEP:
        raise PlanError("the straight line passes a singularity")
    velocities = np.gradient(np.array(joints), duration_s / count, axis=0)
    velocities[-1] = 0.0
    return tuple(
        PathPoint(float(time * duration_s), tuple(q.tolist()), tuple(v.tolist()))
        for time, q, v in zip(times[1:], joints[1:], velocities[1:], strict=True)
    )
