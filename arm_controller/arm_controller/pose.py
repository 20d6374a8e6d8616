"""A pose: one position for each joint of the arm."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from arm_controller.errors import PoseError


@dataclass(frozen=True, slots=True)
class JointPose:
    """Positions (rad or m), one per joint, in the order of `joint_names`.

    A pose that exists is complete and finite; whether the robot can take it is what
    `JointLimits.check` tells.

    Raises:
        PoseError: not one number per joint, or a value that is not a finite number.
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
        """Return the pose of these values; integers are as good as floats.

        Raises:
            PoseError: as the class, and for values that are no numbers at all.
        """
        return cls(tuple(joint_names), tuple(_number(value) for value in values))

    def __str__(self) -> str:
        return "[" + ", ".join(f"{position:.6f}" for position in self.positions) + "]"


def _number(value: object) -> float:
    # bool is a kind of int in Python, but a pose of truth values is a mistake.
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise PoseError(f"a pose is made of numbers; {value!r} is not one")
    try:
        return float(value)
    except OverflowError as error:
        raise PoseError(f"{str(value)[:20]}... is too large a number for a joint") from error
