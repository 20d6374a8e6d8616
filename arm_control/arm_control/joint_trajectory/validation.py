"""Tells trajectories that can be followed from those that cannot."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from arm_control.joint_trajectory.motion import EFFORT, LARGEST
from arm_control.joint_trajectory.requests import FIELDS, TrajectoryRequest, as_rows
from arm_control.joint_trajectory.results import ErrorCode, Refusal

STANDSTILL = float(np.finfo(np.float32).eps)
"""A velocity that counts as none."""


@dataclass(frozen=True, slots=True)
class TrajectoryRules:
    """What a controller takes.

    Attributes:
        joints: its joints.
        allow_partial: whether a trajectory may leave joints out.
        allow_integration: whether points may leave the positions to be integrated.
        allow_moving_end: whether the last point may have a velocity.
        takes_effort: whether points may have efforts.
    """

    joints: tuple[str, ...]
    allow_partial: bool = False
    allow_integration: bool = False
    allow_moving_end: bool = False
    takes_effort: bool = False


def find_fault(
    request: TrajectoryRequest, rules: TrajectoryRules, now_s: float = -math.inf
) -> Refusal | None:
    """Return the first fault of a trajectory, None where it has none.

    Args:
        request: the trajectory.
        rules: what the controller takes.
        now_s: the controller's time, for trajectories with a stamp; -inf where it is not known.
    """
    for code, faults in (
        (ErrorCode.INVALID_JOINTS, _count_faults(request, rules)),
        (ErrorCode.INVALID_GOAL, _emptiness_faults(request)),
        (ErrorCode.INVALID_JOINTS, _name_faults(request, rules)),
        (ErrorCode.INVALID_GOAL, _end_faults(request, rules, now_s)),
        (ErrorCode.INVALID_GOAL, _time_faults(request)),
        (ErrorCode.INVALID_GOAL, _size_faults(request, rules)),
        (ErrorCode.INVALID_GOAL, _number_faults(request)),
    ):
        message = next(faults, None)
        if message is not None:
            return Refusal(code, message)
    return None


def describe_lateness(stamp_s: float, duration_s: float, now_s: float) -> str:
    """Say that a trajectory with a stamp ends in the past; nothing where it does not."""
    end_s = stamp_s + duration_s
    if stamp_s == 0.0 or not end_s < now_s:
        return ""
    return (
        f"Received trajectory with non-zero start time ({stamp_s:f}) "
        f"that ends in the past ({end_s:f})"
    )


def _count_faults(request: TrajectoryRequest, rules: TrajectoryRules) -> Iterator[str]:
    if not rules.allow_partial and len(request.joint_names) != len(rules.joints):
        yield "Joints on incoming trajectory don't match the controller joints."
    if not request.joint_names:
        yield "Empty joint names on incoming trajectory."


def _emptiness_faults(request: TrajectoryRequest) -> Iterator[str]:
    if not request.points:
        yield "Empty trajectory received."


def _name_faults(request: TrajectoryRequest, rules: TrajectoryRules) -> Iterator[str]:
    seen: set[str] = set()
    for name in request.joint_names:
        if name not in rules.joints:
            yield f"Incoming joint {name} doesn't match the controller's joints."
        if name in seen:
            yield f"Incoming joint {name} is named more than once."
        seen.add(name)


def _end_faults(request: TrajectoryRequest, rules: TrajectoryRules, now_s: float) -> Iterator[str]:
    last = request.points[-1]
    if not rules.allow_moving_end:
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
    for i, (before, point) in enumerate(pairwise(request.points)):
        if not before.time_from_start_s < point.time_from_start_s < math.inf:
            yield (
                f"Time between points {i} and {i + 1} is not strictly increasing, it is "
                f"{before.time_from_start_s:f} and {point.time_from_start_s:f} respectively"
            )


def _size_faults(request: TrajectoryRequest, rules: TrajectoryRules) -> Iterator[str]:
    joints = len(request.joint_names)
    for i, point in enumerate(request.points):
        sizes = [len(getattr(point, field)) for field in FIELDS]
        for field, size in zip(FIELDS, sizes, strict=True):
            is_mandatory = field == "positions" and not rules.allow_integration
            if size != joints and (size or is_mandatory):
                yield (
                    f"Mismatch between joint_names size ({joints}) and {field} ({size}) "
                    f"at point #{i}."
                )
        if not any(sizes[:EFFORT]):
            yield "The given trajectory has no position, velocity, or acceleration points."
        if sizes[EFFORT] and not rules.takes_effort:
            yield (
                "Trajectories with effort fields are only supported for controllers using the "
                "'effort' command interface."
            )


def _number_faults(request: TrajectoryRequest) -> Iterator[str]:
    for field in FIELDS:
        given = [(i, getattr(point, field)) for i, point in enumerate(request.points)]
        given = [(i, values) for i, values in given if len(values)]
        # One look at all numbers: a trajectory without fault may have thousands of points.
        numbers = as_rows([values for _, values in given], len(request.joint_names))
        for row, column in np.argwhere(~(np.abs(numbers) <= LARGEST)):
            number = numbers[row, column]
            fault = "too large" if math.isfinite(number) else "not finite"
            yield (
                f"The {field} of joint {request.joint_names[column]} at point #{given[row][0]} "
                f"are {fault}: {number}."
            )
