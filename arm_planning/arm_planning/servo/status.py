"""What a jog says about itself in each period."""

from dataclasses import dataclass
from enum import IntEnum


class StatusCode(IntEnum):
    """The values of moveit_msgs/msg/ServoStatus."""

    INVALID = -1
    NO_WARNING = 0
    DECELERATE_FOR_APPROACHING_SINGULARITY = 1
    HALT_FOR_SINGULARITY = 2
    DECELERATE_FOR_LEAVING_SINGULARITY = 3
    DECELERATE_FOR_COLLISION = 4
    HALT_FOR_COLLISION = 5
    JOINT_BOUND = 6


@dataclass(frozen=True, slots=True)
class JogStatus:
    """A code and a sentence about what slows the jog down or stops it; "" if nothing does."""

    code: StatusCode = StatusCode.NO_WARNING
    message: str = ""


@dataclass(frozen=True, slots=True)
class Slowdown:
    """A reason to go slower.

    Attributes:
        factor: of the speed, 0 to 1.
        status: what to say; it counts only if the factor is below 1.
    """

    factor: float = 1.0
    status: JogStatus = JogStatus()


def slowest(*reasons: Slowdown) -> Slowdown:
    """Return the reason with the least factor; of equal ones the first."""
    return min(reasons, key=lambda reason: reason.factor)
