"""How far and how fast the joints of a pose may go, by the robot's description."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from arm_controller.errors import PoseError
from arm_controller.pose import JointPose

if TYPE_CHECKING:
    from arm_description.robot import Joint, Robot


@dataclass(frozen=True, slots=True)
class JointRange:
    """Range (rad, or m for a prismatic joint) and top speed (the same per second) of one joint.

    Infinite where the description sets no limit.
    """

    name: str
    lower: float
    upper: float
    velocity: float
    unit: str


@dataclass(frozen=True, slots=True)
class JointLimits:
    """The ranges of the joints of a pose, in the pose's order."""

    ranges: tuple[JointRange, ...]

    def check(self, pose: JointPose) -> None:
        """Return if the robot can take this pose.

        Raises:
            PoseError: a position is beyond its joint's limits; names the joint and the limits.
        """
        for allowed, position in zip(self.ranges, pose.positions, strict=True):
            if not allowed.lower <= position <= allowed.upper:
                raise PoseError(
                    f"joint '{allowed.name}' cannot go to {position:g} {allowed.unit}: "
                    f"its limits are {allowed.lower:g} to {allowed.upper:g} {allowed.unit}"
                )

    def range_of(self, name: str) -> JointRange:
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


def no_limits(joint_names: Sequence[str]) -> JointLimits:
    """Return limits that allow everything: those of a robot that is not known."""
    return JointLimits(
        tuple(JointRange(name, -math.inf, math.inf, math.inf, "rad") for name in joint_names)
    )


def limits_of(robot: "Robot", joint_names: Sequence[str]) -> JointLimits:
    """Return the limits of these joints.

    Raises:
        UrdfError: the robot has no joint of that name; names those that it has.
        PoseError: a joint of that name is there but does not move.
    """
    return JointLimits(tuple(_range_of(robot.joint(name)) for name in joint_names))


def _range_of(joint: "Joint") -> JointRange:
    if joint.type == "fixed":
        raise PoseError(f"joint '{joint.name}' is fixed: it cannot be part of a pose")
    unit = "m" if joint.type == "prismatic" else "rad"
    limit = joint.limit
    if limit is None:
        return JointRange(joint.name, -math.inf, math.inf, math.inf, unit)
    # A speed limit of zero is how some descriptions say that they know none.
    velocity = limit.velocity if limit.velocity > 0.0 else math.inf
    return JointRange(joint.name, limit.lower, limit.upper, velocity, unit)
