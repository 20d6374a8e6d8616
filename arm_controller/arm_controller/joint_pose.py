"""A pose of the robot's joints, and its limits."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from arm_controller.errors import PoseError

if TYPE_CHECKING:
    from arm_description.urdf.robot import Joint, Robot


@dataclass(frozen=True, slots=True)
class JointPose:
    """Positions (rad or m), one per joint, in the order of `joint_names`.

    A pose is always complete and finite; `PoseLimits.check` tells whether the robot can reach it.

    Raises:
        PoseError: there is not one number per joint, or a value is not finite.
    """

    joint_names: tuple[str, ...]
    positions: tuple[float, ...]

    def __post_init__(self) -> None:
        if len(self.positions) != len(self.joint_names):
            raise PoseError(
                f"a pose is {len(self.joint_names)} numbers, one for each of the joints "
                f"{', '.join(self.joint_names)}; {len(self.positions)} were given"
            )
        for name, position in zip(self.joint_names, self.positions, strict=True):
            if not math.isfinite(position):
                raise PoseError(f"joint '{name}' cannot go to {position}: not a finite number")

    @classmethod
    def of(cls, joint_names: Sequence[str], values: Sequence[object]) -> "JointPose":
        """Return the pose with these values, integers or floats.

        Raises:
            PoseError: see the class; also for values that are not numbers.
        """
        return cls(tuple(joint_names), tuple(_number(value) for value in values))

    def __str__(self) -> str:
        return "[" + ", ".join(f"{position:.6f}" for position in self.positions) + "]"


def _number(value: object) -> float:
    # bool is a subclass of int, but a bool in a pose is a mistake.
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise PoseError(f"a pose is made of numbers; {value!r} is not one")
    try:
        return float(value)
    except OverflowError as error:
        raise PoseError(f"{str(value)[:20]}... is too large a number for a joint") from error


@dataclass(frozen=True, slots=True)
class AllowedRange:
    """Range (rad, or m for a prismatic joint) and top speed (the same per second) of one joint.

    Infinite if the description has no limit.
    """

    name: str
    lower: float
    upper: float
    velocity: float
    unit: str


@dataclass(frozen=True, slots=True)
class PoseLimits:
    """The ranges of the joints of a pose, in the pose's order."""

    ranges: tuple[AllowedRange, ...]

    def check(self, pose: JointPose) -> None:
        """Check that the robot can reach a pose.

        Raises:
            PoseError: a position is beyond its joint's limits; the message names both.
        """
        for allowed, position in zip(self.ranges, pose.positions, strict=True):
            if not allowed.lower <= position <= allowed.upper:
                raise PoseError(
                    f"joint '{allowed.name}' cannot go to {position:g} {allowed.unit}: "
                    f"its limits are {allowed.lower:g} to {allowed.upper:g} {allowed.unit}"
                )

    def range_of(self, name: str) -> AllowedRange:
        """Return the range of the joint of this name, which must be one of the pose's."""
        return next(allowed for allowed in self.ranges if allowed.name == name)

    def shortest_move_s(self, start: Mapping[str, float], pose: JointPose) -> tuple[str, float]:
        """Return the joint that takes longest at its top speed, and how long it takes (s).

        Args:
            start: position by joint name; joints that it lacks count as not moving.
            pose: the goal.
        """
        times = [
            (abs(position - start.get(allowed.name, position)) / allowed.velocity, allowed.name)
            for allowed, position in zip(self.ranges, pose.positions, strict=True)
        ]
        longest_s, name = max(times)
        return name, longest_s


def no_limits(joint_names: Sequence[str]) -> PoseLimits:
    """Return limits that allow every pose, for an unknown robot."""
    return PoseLimits(
        tuple(AllowedRange(name, -math.inf, math.inf, math.inf, "rad") for name in joint_names)
    )


def limits_of(robot: "Robot", joint_names: Sequence[str]) -> PoseLimits:
    """Return the limits of these joints.

    Raises:
        UrdfError: the robot has no joint of that name; the message names its joints.
        PoseError: a joint is fixed.
    """
    return PoseLimits(tuple(_range_of(robot.joint(name)) for name in joint_names))


def _range_of(joint: "Joint") -> AllowedRange:
    if joint.type == "fixed":
        raise PoseError(f"joint '{joint.name}' is fixed: it cannot be part of a pose")
    unit = joint.type.unit
    limit = joint.limit
    if limit is None:
        return AllowedRange(joint.name, -math.inf, math.inf, math.inf, unit)
    # In some descriptions a speed limit of 0 means that there is none.
    velocity = limit.velocity if limit.velocity > 0.0 else math.inf
    return AllowedRange(joint.name, limit.lower, limit.upper, velocity, unit)
