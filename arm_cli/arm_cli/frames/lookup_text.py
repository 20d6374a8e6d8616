"""A lookup as tf2_echo prints it."""

import math
from collections.abc import Iterable

from arm_cli.frames.frame_log import Lookup


def describe_lookup(lookup: Lookup) -> str:
    """Return the lines that tf2_echo prints for a transform."""
    pose = lookup.pose
    rpy = pose.rpy()
    seconds, nanoseconds = divmod(round(lookup.stamp_s * 1e9), 1_000_000_000)
    return "\n".join(
        [
            f"At time {seconds}.{nanoseconds:09d}",
            f"- Translation: {_numbers(pose.translation)}",
            f"- Rotation: in Quaternion (xyzw) {_numbers(pose.quaternion)}",
            f"- Rotation: in RPY (radian) {_numbers(rpy)}",
            f"- Rotation: in RPY (degree) {_numbers(math.degrees(angle) for angle in rpy)}",
            "- Matrix:",
            *("".join(f" {_rounded(value):6.3f}" for value in row) for row in pose.matrix()),
        ]
    )


def _numbers(values: Iterable[float]) -> str:
    return f"[{', '.join(f'{_rounded(value):.3f}' for value in values)}]"


def _rounded(value: float) -> float:
    # Adding 0 turns -0 into 0.
    return round(value, 3) + 0.0
