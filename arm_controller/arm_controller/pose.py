"""A pose of the robot's joints, and the limits that it must keep to."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from arm_description.urdf.parser import parse_urdf

Pose = tuple[float, ...]
"""Positions (rad or m), one per joint, in the order of the joints."""


class ArmControllerError(Exception):
    """Root of this package's errors; every message is a sentence for the user."""


class PoseError(ArmControllerError):
    """A pose has the wrong length, is not finite, or exceeds a joint's limits."""


def read_pose(values: Sequence[object], joints: Sequence[str]) -> Pose:
    """Return integers or floats as a pose.

    Raises:
        PoseError: there is not one finite number per joint.
    """
    pose = tuple(_number(value) for value in values)
    if len(pose) != len(joints):
        raise PoseError(
            f"a pose is {len(joints)} numbers, one for each of the joints "
            f"{', '.join(joints)}; {len(pose)} were given"
        )
    for name, position in zip(joints, pose, strict=True):
        if not math.isfinite(position):
            raise PoseError(f"joint '{name}' cannot go to {position}: not a finite number")
    return pose


def _number(value: object) -> float:
    # bool is a subclass of int, but a bool in a pose is a mistake.
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise PoseError(f"a pose is made of numbers; {value!r} is not one")
    try:
        return float(value)
    except OverflowError as error:
        raise PoseError(f"{str(value)[:20]}... is too large a number for a joint") from error


def shown(pose: Pose) -> str:
    """Return a pose as the nodes print it."""
    return "[" + ", ".join(f"{position:.6f}" for position in pose) + "]"


@dataclass(frozen=True, slots=True)
class AllowedRange:
    """Range (rad, or m for a prismatic joint) and top speed (the same per second) of one joint."""

    name: str
    lower: float = -math.inf
    upper: float = math.inf
    velocity: float = math.inf
    unit: str = "rad"


Limits = tuple[AllowedRange, ...]
"""The limits of the joints of a pose, in its order."""


def read_limits(description: str, joints: Sequence[str]) -> Limits:
    """Return the limits that a URDF gives to these joints.

    Raises:
        DescriptionError: it is no URDF, or has no joint of a name; the message names its joints.
        PoseError: a joint is fixed.
    """
    robot = parse_urdf(description, "robot_description")
    limits: list[AllowedRange] = []
    for name in joints:
        joint = robot.joint(name)
        if joint.type == "fixed":
            raise PoseError(f"joint '{name}' is fixed: it cannot be part of a pose")
        unit, limit = joint.type.unit, joint.limit
        if limit is None:
            limits.append(AllowedRange(name, unit=unit))
        else:
            # In some descriptions a speed limit of 0 means that there is none.
            velocity = limit.velocity if limit.velocity > 0.0 else math.inf
            limits.append(AllowedRange(name, limit.lower, limit.upper, velocity, unit))
    return tuple(limits)


def check_limits(pose: Pose, limits: Limits) -> None:
    """Check that the robot can reach a pose.

    Raises:
        PoseError: a position is beyond its joint's limits; the message names both.
    """
    for limit, position in zip(limits, pose, strict=True):
        if not limit.lower <= position <= limit.upper:
            raise PoseError(
                f"joint '{limit.name}' cannot go to {position:g} {limit.unit}: "
                f"its limits are {limit.lower:g} to {limit.upper:g} {limit.unit}"
            )


def shortest_move(
    pose: Pose, start: Mapping[str, float], limits: Limits
) -> tuple[AllowedRange, float]:
    """Return the joint that takes longest at its top speed, and how long it takes (s).

    Joints of unknown start count as not moving.
    """
    times = {
        limit: abs(position - start.get(limit.name, position)) / limit.velocity
        for limit, position in zip(limits, pose, strict=True)
    }
    slowest = max(times, key=lambda limit: (times[limit], limit.name))
    return slowest, times[slowest]
