"""All parts of the arm, from the floor to the fingertips."""

from arm_meshes.bracket import bracket
from arm_meshes.foot import foot
from arm_meshes.gripper import finger, gripper_plate
from arm_meshes.part import Part
from arm_meshes.servo import horn, servo
from arm_meshes.turntable import disc, plate
from arm_meshes.wrist import wrist


def all_parts() -> tuple[Part, ...]:
    """Return every part once; links that look alike share one."""
    return (
        foot(),
        plate(),
        disc(),
        servo(),
        horn(),
        bracket(),
        wrist(),
        gripper_plate(),
        finger(),
    )
