"""Between which positions a slider moves its joint."""

import math
from collections.abc import Iterable
from dataclasses import dataclass

from arm_description.joint_state_merge import PUBLISHED, position_range
from arm_description.robot import Joint

STEPS = 1000


@dataclass(frozen=True, slots=True)
class JointRange:
    """The joint's limits, soft ones included: rad, or m for a prismatic joint."""

    name: str
    lower: float
    upper: float

    @property
    def centre(self) -> float:
        """0 where the joint can be there, else the middle, as joint_state_publisher_gui has it."""
        return 0.0 if self.lower <= 0.0 <= self.upper else 0.5 * (self.lower + self.upper)

    @property
    def step(self) -> float:
        """The power of ten that makes some thousand steps of the range."""
        return 10.0**-self._digits

    def nearest(self, position: float) -> float:
        """Return the position within the limits, and of whole steps, that is nearest."""
        # To digits, not to multiples of the step: those would be shown as 0.7000000000000001.
        whole = round(position, self._digits)
        # Adding 0.0 makes 0.0 of -0.0, which would be shown with its sign.
        return min(max(whole, self.lower), self.upper) + 0.0

    @property
    def _digits(self) -> int:
        """After the point, of a whole step; negative where steps are tens or more."""
        return -math.floor(math.log10((self.upper - self.lower) / STEPS))


def joint_ranges(joints: Iterable[Joint]) -> tuple[JointRange, ...]:
    """Return the ranges of the joints that a slider can move.

    These have one position, of their own, and room to move; a mimicking joint follows its leader.
    """
    ranges = []
    for joint in joints:
        if joint.mimic is not None or joint.type not in PUBLISHED:
            continue
        lower, upper = position_range(joint)
        if math.isfinite(upper - lower) and lower < upper:
            ranges.append(JointRange(joint.name, lower, upper))
    return tuple(ranges)
