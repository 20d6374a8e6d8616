"""What a jog is asked for: speeds of joints, a twist of the tip, or a pose that it is to reach."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import IntEnum

from arm_node.names import describe_known
from arm_node.rigid_transform import RigidTransform, Vector
from arm_planning.errors import InvalidRequestError


class CommandType(IntEnum):
    """The values of moveit_msgs/srv/ServoCommandType."""

    JOINT_JOG = 0
    TWIST = 1
    POSE = 2


@dataclass(frozen=True, slots=True)
class JointSpeeds:
    """Speeds of joints by name, unitless or in rad/s and m/s; joints not named stand still."""

    speeds: Mapping[str, float]

    @classmethod
    def of(
        cls, names: Sequence[str], velocities: Sequence[float], joints: Sequence[str]
    ) -> "JointSpeeds":
        """Return the speeds in a message for the joints of a group.

        Raises:
            PlanningError: a joint is not in the group, comes twice or has no finite speed.
        """
        if len(names) != len(velocities):
            raise InvalidRequestError(f"{len(names)} joint names have {len(velocities)} velocities")
        for name, speed in zip(names, velocities, strict=True):
            if name not in joints:
                raise InvalidRequestError(
                    f"no joint '{name}'; {describe_known(name, joints, 'the group has')}"
                )
            if not math.isfinite(speed):
                raise InvalidRequestError(f"the velocity of '{name}' is {speed}")
        if len(set(names)) < len(names):
            raise InvalidRequestError("a joint is named twice")
        return cls(dict(zip(names, velocities, strict=True)))


@dataclass(frozen=True, slots=True)
class TipTwist:
    """A velocity of the tip, which turns about itself, on the axes of a frame.

    Attributes:
        linear: unitless or in m/s.
        angular: unitless or in rad/s.
        frame: a frame of the scene; "" for the planning frame.
    """

    linear: Vector
    angular: Vector
    frame: str = ""

    def __post_init__(self) -> None:
        if not all(map(math.isfinite, (*self.linear, *self.angular))):
            raise InvalidRequestError(f"the twist is not finite: {(*self.linear, *self.angular)}")


@dataclass(frozen=True, slots=True)
class TipTarget:
    """A pose that the tip is to reach and to keep, in a frame; "" for the planning frame."""

    pose: RigidTransform
    frame: str = ""


JogCommand = JointSpeeds | TipTwist | TipTarget
