"""Rejects trajectories that the controller cannot follow or that break joint limits."""

import math
from collections.abc import Iterator

import numpy as np

from arm_control.controllers.angles import nearest_turn
from arm_control.controllers.joint_trajectory.configuration import Configuration, JointModel
from arm_control.controllers.joint_trajectory.goals import ErrorCode, GoalRefusal
from arm_control.controllers.joint_trajectory.parameters import (
    JointTrajectoryParameters as Parameters,
)
from arm_control.controllers.joint_trajectory.profiles import (
    EFFORT,
    LARGEST,
    POSITION,
    RESOLUTION_S,
    VELOCITY,
    Array,
    MotionProfile,
)
from arm_control.controllers.joint_trajectory.trajectory import (
    FIELDS,
    Trajectory,
    TrajectoryRequest,
)

SAMPLES_PER_SEGMENT = 8
"""Enough to see a polynomial of degree five overshoot between its ends."""

SLACK = 1e-6
"""Tolerance of the limit checks: planners go exactly to the limit."""

STANDSTILL = float(np.finfo(np.float32).eps)
"""Velocities up to this count as 0."""


def find_fault(
    request: TrajectoryRequest, parameters: Parameters, now_s: float = -math.inf
) -> GoalRefusal | None:
    """Return the first fault of a trajectory, or None.

    `now_s`, the controller's time, is for trajectories with a stamp; -inf if unknown.
    """
    for code, faults in (
        (ErrorCode.INVALID_JOINTS, _count_faults(request, parameters)),
        (ErrorCode.INVALID_GOAL, _emptiness_faults(request)),
        (ErrorCode.INVALID_JOINTS, _name_faults(request, parameters)),
        (ErrorCode.INVALID_GOAL, _end_faults(request, parameters, now_s)),
        (ErrorCode.INVALID_GOAL, _time_faults(request)),
        (ErrorCode.INVALID_GOAL, _size_faults(request, parameters)),
        (ErrorCode.INVALID_GOAL, _number_faults(request)),
    ):
        message = next(faults, None)
        if message is not None:
            return GoalRefusal(code, message)
    return None


def describe_lateness(stamp_s: float, duration_s: float, now_s: float) -> str:
    """Return a message if a trajectory with a stamp ends in the past; else an empty string."""
    end_s = stamp_s + duration_s
    if stamp_s == 0.0 or not end_s < now_s:
        return ""
    return (
        f"Received trajectory with non-zero start time ({stamp_s:f}) "
        f"that ends in the past ({end_s:f})"
    )


def _count_faults(request: TrajectoryRequest, parameters: Parameters) -> Iterator[str]:
    is_partial = len(request.joint_names) != len(parameters.joints)
    if is_partial and not parameters.allow_partial_joints_goal:
        yield "Joints on incoming trajectory don't match the controller joints."
    if not request.joint_names:
        yield "Empty joint names on incoming trajectory."


def _emptiness_faults(request: TrajectoryRequest) -> Iterator[str]:
    if not request.points:
        yield "Empty trajectory received."


def _name_faults(request: TrajectoryRequest, parameters: Parameters) -> Iterator[str]:
    seen: set[str] = set()
    for name in request.joint_names:
        if name not in parameters.joints:
            yield f"Incoming joint {name} doesn't match the controller's joints."
        if name in seen:
            yield f"Incoming joint {name} is named more than once."
        seen.add(name)


def _end_faults(request: TrajectoryRequest, parameters: Parameters, now_s: float) -> Iterator[str]:
    last = request.points[-1]
    if not parameters.allow_nonzero_velocity_at_trajectory_end:
        for name, velocity in zip(request.joint_names, last.velocities, strict=False):
            if abs(velocity) > STANDSTILL:
                yield (
                    f"Velocity of last trajectory point of joint {name} is not zero: "
                    f"{velocity:.15f}"
                )
    lateness = describe_lateness(request.stamp_s, last.time_from_start_s, now_s)
    if lateness:
        yield lateness


def _time_faults(request: TrajectoryRequest) -> Iterator[str]:
    first_s = request.points[0].time_from_start_s
    if not (math.isfinite(request.stamp_s) and 0.0 <= first_s < math.inf):
        yield (
            f"The trajectory starts at {request.stamp_s:f} with its first point at {first_s:f}: "
            "both must be finite, and the second must not be negative."
        )
    times_s = request.way_points.times_s
    rises = (times_s[:-1] < times_s[1:]) & (times_s[1:] < math.inf)
    for i in np.flatnonzero(~rises):
        yield (
            f"Time between points {i} and {i + 1} is not strictly increasing, it is "
            f"{times_s[i]:f} and {times_s[i + 1]:f} respectively"
        )


def _size_faults(request: TrajectoryRequest, parameters: Parameters) -> Iterator[str]:
    joints = len(request.joint_names)
    takes_effort = "effort" in parameters.command_interfaces
    every = request.way_points.sizes
    integrates = parameters.allow_integration_in_goal_trajectories
    mandatory = [field == "positions" and not integrates for field in FIELDS]
    faulty = ((every != joints) & ((every > 0) | mandatory)).any(axis=1)
    faulty |= ~every[:, :EFFORT].any(axis=1)
    faulty |= (every[:, EFFORT] > 0) & (not takes_effort)
    for i in np.flatnonzero(faulty):
        sizes = every[i].tolist()
        for field, size, is_mandatory in zip(FIELDS, sizes, mandatory, strict=True):
            if size != joints and (size or is_mandatory):
                yield (
                    f"Mismatch between joint_names size ({joints}) and {field} ({size}) "
                    f"at point #{i}."
                )
        if not any(sizes[:EFFORT]):
            yield "The given trajectory has no position, velocity, or acceleration points."
        if sizes[EFFORT] and not takes_effort:
            yield (
                "Trajectories with effort fields are only supported for controllers using the "
                "'effort' command interface."
            )


def _number_faults(request: TrajectoryRequest) -> Iterator[str]:
    for row_of_field, field in enumerate(FIELDS):
        given, numbers = request.way_points.given(row_of_field, len(request.joint_names))
        for row, column in np.argwhere(~(np.abs(numbers) <= LARGEST)):
            number = numbers[row, column]
            fault = "too large" if math.isfinite(number) else "not finite"
            yield (
                f"The {field} of joint {request.joint_names[column]} at point #{given[row]} "
                f"are {fault}: {number}."
            )


def velocity_violations(
    trajectory: Trajectory, model: JointModel, start: Array, offset_s: float
) -> str | None:
    """Return which joint a trajectory drives beyond its velocity limit, or None.

    A quick check for trajectories that are executed anyway: it considers the velocity at each point
    and the mean velocity from the previous one. A profile may be faster in between. The
    trajectory starts `offset_s` from now, at the positions `start`, shape (n,).
    """
    due_s = trajectory.times_s + offset_s
    coming = due_s > RESOLUTION_S
    points = trajectory.motions[coming]
    if not len(points):
        return None
    start = nearest_turn(start, points[0, POSITION], model.continuous)
    distances = np.abs(np.diff(np.vstack([start, points[:, POSITION]]), axis=0))
    paces = distances / np.diff(due_s[coming], prepend=0.0)[:, None]
    # Missing values are NaN: fmax ignores them, and a comparison with NaN is false.
    speeds = np.fmax(paces, np.abs(points[:, VELOCITY]))
    excess = np.where(speeds > model.velocity + SLACK, speeds / model.velocity, 0.0)
    row, i = np.unravel_index(np.argmax(excess), excess.shape)
    if not excess[row, i]:
        return None
    number, unit = np.flatnonzero(coming)[row] + 1, model.units[i]
    return (
        f"joint {model.joints[i]} would have to move at {speeds[row, i]:.4g} {unit}/s to reach "
        f"point {number} of {len(due_s)} in time; its velocity limit is "
        f"{model.velocity[i]:.4g} {unit}/s"
    )


def limit_violations(
    profile: MotionProfile, times_s: Array, present: Array, configuration: Configuration
) -> GoalRefusal | None:
    """Return which of the checked limits a profile violates, or None.

    The motion between waypoints is checked at a few samples. A joint that is already beyond a limit
    may stay there or move back, but not further. `times_s` (m,) are the times of its waypoints; the
    present positions (k, n) are measured and commanded, NaN if unknown.
    """
    knots_s = np.concatenate([[0.0], times_s[times_s > 0.0]])
    fractions = np.arange(SAMPLES_PER_SEGMENT) / SAMPLES_PER_SEGMENT
    between_s = knots_s[:-1, None] + np.diff(knots_s)[:, None] * fractions
    sampled_s = np.append(between_s, knots_s[-1])
    motions = np.stack([profile.sample(time_s) for time_s in sampled_s.tolist()])
    model, parameters = configuration.model, configuration.parameters
    if parameters.check_position_limits:
        position = motions[:, POSITION]
        lower = np.fmin.reduce(np.vstack([model.lower, present]))
        upper = np.fmax.reduce(np.vstack([model.upper, present]))
        outside = (position < lower - SLACK) | (position > upper + SLACK)
        for row, i in np.argwhere(outside):
            return _refusal(
                f"The trajectory takes joint {model.joints[i]} to {position[row, i]:f}, "
                f"outside its limits [{model.lower[i]:f}, {model.upper[i]:f}]",
                float(sampled_s[row]),
            )
    if parameters.check_velocity_limits:
        speed = np.abs(motions[:, VELOCITY])
        for row, i in np.argwhere(speed > model.velocity + SLACK):
            return _refusal(
                f"The trajectory moves joint {model.joints[i]} at {speed[row, i]:f}, "
                f"above its velocity limit of {model.velocity[i]:f}",
                float(sampled_s[row]),
            )
    return None


def _refusal(fault: str, time_s: float) -> GoalRefusal:
    return GoalRefusal(ErrorCode.INVALID_GOAL, f"{fault}, {time_s:.3f} s after its start.")
