"""A line that a person types at the prompt: one number per joint, separated by spaces."""

from collections.abc import Sequence

from arm_controller.errors import CommandLineError
from arm_controller.pose import JointPose


def prompt(joint_names: Sequence[str]) -> str:
    """Return what the terminal asks for."""
    return f"Enter the {len(joint_names)} Joint Variables to send (separated by spaces): "


def parse_pose_line(line: str, joint_names: Sequence[str]) -> JointPose:
    """Return the pose that a line stands for.

    Raises:
        CommandLineError: not exactly as many numbers as joints.
        PoseError: a number that is not finite.
    """
    wanted = f"Please enter exactly {len(joint_names)} numbers."
    words = line.split()
    if len(words) != len(joint_names):
        raise CommandLineError(f"{wanted} (There were {len(words)}.)")
    values: list[float] = []
    for word in words:
        try:
            values.append(float(word))
        except ValueError as error:
            raise CommandLineError(f"{wanted} ('{word}' is not a number.)") from error
    return JointPose.of(joint_names, values)
