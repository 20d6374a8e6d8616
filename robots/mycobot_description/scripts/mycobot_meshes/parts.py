"""All parts of the robot, from the floor to the fingertips."""

from arm_meshes.part import Part

from mycobot_meshes.base import base_plate, pedestal
from mycobot_meshes.elbow import forearm_elbow, shoulder
from mycobot_meshes.finger import finger
from mycobot_meshes.gripper_body import gripper_body
from mycobot_meshes.lever import bars, geared_lever
from mycobot_meshes.segment import forearm, upper_arm
from mycobot_meshes.wrist import flange, wrist


def all_parts() -> tuple[Part, ...]:
    """Return every part, each named after its link."""
    arm = (base_plate(), pedestal(), shoulder(), upper_arm(), forearm(), forearm_elbow())
    gripper = [make(side) for side in ("left", "right") for make in (finger, bars, geared_lever)]
    return (*arm, wrist(), flange(), gripper_body(), *gripper)
