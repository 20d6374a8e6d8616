"""Times for a joint path: as fast as the limits allow, with rounded corners."""

import logging
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from arm_planning.errors import InvalidPlanError, InvalidRequestError
from arm_planning.robot.model import PlanningLimits
from arm_planning.timing import stepped_motion
from arm_planning.timing.driven_spline import limit_violation
from arm_planning.timing.fastest_profile import fastest
from arm_planning.timing.rounded_path import rounded_paths
from arm_planning.timing.stepped_motion import MotionLimits
from arm_planning.trajectory import TimedTrajectory

Array = NDArray[np.float64]

PATH_TOLERANCE = 0.1
RESAMPLE_DT_S = 0.1
MIN_ANGLE_CHANGE = 0.001
"""MoveIt's defaults of totg.path_tolerance, totg.resample_dt and totg.min_angle_change."""

_CLOSENESS = 2e-4
"""How far the trajectory may leave the rounded path, in rad or m."""
_LARGEST_ACCELERATION = 6.0 * _CLOSENESS / stepped_motion.SMALLEST_STEP_S**2
"""Larger limits are not used to the full; the shortest steps could not stay on the path."""

_LARGEST_POSITION = 1e6
"""Larger positions, in rad or m, are refused; they leave no digits for accelerations."""
_EQUAL = 1e-9
"""States this near count as equal, in rad or m."""

_log = logging.getLogger(__name__)


def parameterize(
    path: ArrayLike,
    limits: Sequence[PlanningLimits],
    *,
    joints: Sequence[str],
    velocity_scaling: float = 1.0,
    acceleration_scaling: float = 1.0,
    path_tolerance: float = PATH_TOLERANCE,
    resample_dt: float = RESAMPLE_DT_S,
    min_angle_change: float = MIN_ANGLE_CHANGE,
    max_deviation: ArrayLike | None = None,
    limit_jerk: bool = False,
) -> TimedTrajectory:
    """Return the fastest trajectory along a path, from rest to rest.

    Velocity and acceleration limits hold at every instant of the curve that a joint trajectory
    controller drives through the points. Its positions stay between the smallest and the largest
    of the way points, so position limits hold if the way points hold them. A path whose states are
    all equal gives one point at rest.

    Corners are rounded within the tolerances; on top of that the trajectory leaves the path by at
    most 0.2 mrad or mm. The running mean of `limit_jerk` cuts corners further, by at most
    a t^2 / 8 at an acceleration limit a and a mean over t = 2 a / jerk.

    Args:
        path: way points, rad or m, (m, n), m >= 1; continuous joints are not wrapped.
        limits: the limits of each joint.
        joints: names, for the trajectory and for messages.
        velocity_scaling: fraction of the velocity limits to use; see `scaling_factor`.
        acceleration_scaling: fraction of the acceleration limits to use.
        path_tolerance: how far the motion may pass by a way point, as a distance in joint space.
        resample_dt: largest time between points; they are closer where the limits ask for it.
        min_angle_change: way points between the first and the last are dropped if no joint moves
            farther than this from the way point before.
        max_deviation: tighter tolerances of single way points, (m,); the motion stops at a corner
            where it is 0.
        limit_jerk: whether to hold the finite jerk limits too.

    Raises:
        PlanningError: INVALID_MOTION_PLAN: no way points, or one that is not finite; FAILURE: a
            joint that moves has no usable limit, or the motion would take too long.
    """
    points = _checked(path, joints)
    tolerances = _tolerances(max_deviation, path_tolerance, len(points))
    _require_step(resample_dt)
    kept = _distinct(points, min_angle_change)
    points, tolerances = points[kept], tolerances[kept]
    if len(points) == 1:
        rest = np.zeros_like(points)
        return TimedTrajectory(tuple(joints), np.zeros(1), points, rest, rest.copy())
    speed = scaling_factor(velocity_scaling, "velocity")
    haste = scaling_factor(acceleration_scaling, "acceleration")
    bounds = _bounds(points, limits, joints, speed, haste, limit_jerk)
    trajectory = _timed(points, tolerances, joints, bounds, resample_dt)
    fault = limit_violation(trajectory, bounds.limits(), with_jerk=limit_jerk)
    if fault:
        raise InvalidRequestError(f"the timing broke a limit: {fault}")
    return trajectory


def scaling_factor(value: float, name: str) -> float:
    """Return a scaling factor, or 1 with a warning if it is not in (0, 1], as in MoveIt.

    Args:
        value: the factor of a request.
        name: "velocity" or "acceleration".
    """
    if 0.0 < value <= 1.0:
        return value
    _log.warning(
        "Invalid max_%s_scaling_factor %f specified, defaulting to 1.000000 instead.", name, value
    )
    return 1.0


def _checked(path: ArrayLike, joints: Sequence[str]) -> Array:
    points = np.array(path, dtype=np.float64)
    if points.size == 0:
        raise InvalidPlanError("the path has no way points")
    if points.ndim != 2 or points.shape[1] != len(joints):
        raise ValueError(f"a path of {len(joints)} joints has shape (m, {len(joints)})")
    usable = np.abs(points) <= _LARGEST_POSITION
    if not usable.all():
        row, column = np.argwhere(~usable)[0].tolist()
        raise InvalidPlanError(
            f"way point {row} of the path has {points[row, column]:g} for joint "
            f"'{joints[column]}'; a position must be a number of at most {_LARGEST_POSITION:g}"
        )
    return points


def _tolerances(max_deviation: ArrayLike | None, path_tolerance: float, count: int) -> Array:
    tolerances = np.full(count, path_tolerance)
    if max_deviation is not None:
        tolerances = np.minimum(tolerances, np.asarray(max_deviation, dtype=np.float64))
    if not (tolerances >= 0.0).all():
        raise InvalidRequestError(
            f"the path tolerance is {tolerances.min():g}; it must not be negative"
        )
    return tolerances


def _require_step(resample_dt: float) -> None:
    if not stepped_motion.SMALLEST_STEP_S <= resample_dt < np.inf:
        raise InvalidRequestError(
            f"resample_dt is {resample_dt:g} s; it must be at least "
            f"{stepped_motion.SMALLEST_STEP_S:g} s"
        )


def _distinct(points: Array, min_angle_change: float) -> NDArray[np.intp]:
    """Return the way points to keep: each far enough from the one before, and both ends."""
    least, last = max(min_angle_change, _EQUAL), len(points) - 1
    kept = list(range(last + 1))
    if not (_changes(points[1:], points[:-1]) > least).all():
        kept = [0]
        for row in range(1, last + 1):
            if _changes(points[row], points[kept[-1]]) > least:
                kept.append(row)
    if kept[-1] != last:
        # The last takes the place of one that it is near to, but for the first.
        kept = [0, *kept[1:-1]]
        if _changes(points[last], points[kept[-1]]) > _EQUAL:
            kept.append(last)
    return np.array(kept, dtype=np.intp)


def _changes(points: Array, others: Array) -> Array:
    """Return the largest change of a joint between way points."""
    return np.abs(points - others).max(axis=-1)


def _bounds(
    points: Array,
    limits: Sequence[PlanningLimits],
    joints: Sequence[str],
    velocity_scaling: float,
    acceleration_scaling: float,
    limit_jerk: bool,
) -> MotionLimits:
    """Return the limits to hold; joints that do not move have none."""
    moves = np.ptp(points, axis=0) > 0.0
    rows: dict[str, Array] = {}
    for name in ("velocity", "acceleration"):
        rows[name] = np.array([getattr(limit, name) for limit in limits], dtype=np.float64)
        for column in np.flatnonzero(moves).tolist():
            _require(float(rows[name][column]), name, joints[column])
    jerk = [limit.jerk if limit_jerk and limit.jerk > 0.0 else np.inf for limit in limits]
    return MotionLimits(
        np.where(moves, velocity_scaling * rows["velocity"], np.inf),
        np.where(
            moves,
            np.minimum(acceleration_scaling * rows["acceleration"], _LARGEST_ACCELERATION),
            np.inf,
        ),
        np.where(moves, np.array(jerk, dtype=np.float64), np.inf),
        _CLOSENESS,
    )


def _require(limit: float, name: str, joint: str) -> None:
    if limit == np.inf:
        raise InvalidRequestError(
            f"No {name} limit was defined for joint {joint}! "
            f"Set has_{name}_limits and max_{name} in joint_limits.yaml"
        )
    if not limit > 0.0:
        raise InvalidRequestError(
            f"Invalid max_{name} {limit:g} specified for joint {joint}; it must be greater than 0"
        )


def _timed(
    points: Array,
    tolerances: Array,
    joints: Sequence[str],
    bounds: MotionLimits,
    resample_dt: float,
) -> TimedTrajectory:
    moving = np.isfinite(bounds.acceleration)
    runs = [
        fastest(path, bounds.velocity, bounds.acceleration)
        for path in rounded_paths(points, tolerances)
    ]
    step = stepped_motion.step_for(
        sum(run.duration_s for run in runs),
        len(runs),
        float(bounds.acceleration[moving].max()),
        resample_dt,
        bounds.closeness,
    )
    window = float((2.0 * bounds.acceleration[moving] / bounds.jerk[moving]).max())
    if window > 0.0:
        # The mean over `window` of a motion with jumps of 2 a holds the jerk limit.
        step = min(step, max(window / 4.0, stepped_motion.SMALLEST_STEP_S))
    control = stepped_motion.joined(
        [run.positions(stepped_motion.steps(run.duration_s, step)) for run in runs],
        int(np.ceil(window / step)),
    )
    return stepped_motion.trajectory(joints, control, step, bounds, resample_dt)
