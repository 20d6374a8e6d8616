"""Poses of frames in the root of their tree, from /tf or assumed while /tf lacks them."""

import math
from collections.abc import Container, Mapping

import numpy as np

from arm_description.kinematics.forward import forward_kinematics, resolve_mimics
from arm_description.transforms import quaternion_from_rpy, rpy_from_rotation
from arm_description.urdf.joint_type import JointType
from arm_description.urdf.robot import Joint, Robot
from arm_node.rigid_transform import RigidTransform
from arm_viewer.snapshot import Transform


def frame_poses(transforms: Mapping[str, Transform]) -> dict[str, RigidTransform]:
    """Return the pose of every frame, including roots; frames in a loop have no pose."""
    poses: dict[str, RigidTransform] = {}
    for frame in transforms:
        chain: dict[str, Transform] = {}
        while frame not in poses and frame in transforms and frame not in chain:
            chain[frame] = transforms[frame]
            frame = transforms[frame].parent
        if frame in chain:
            continue
        pose = poses.setdefault(frame, RigidTransform())
        for child, step in reversed(chain.items()):
            pose = poses[child] = pose.then(step.pose)
    return poses


def assumed_transforms(
    robot: Robot,
    places: Mapping[str, str],
    initial: Mapping[str, float],
    known: Container[str],
) -> dict[str, Transform]:
    """Return the transforms that /tf lacks, by child frame, with joints at their initial positions.

    Args:
        robot: the robot.
        places: the frame of each link.
        initial: initial joint positions, rad or m; other joints are at 0, or at the nearest limit
            if 0 is outside their limits.
        known: the frames that have a transform to their parent.
    """
    missing = [joint for joint in robot.joints if places[joint.child] not in known]
    if not missing:
        return {}
    free = {j.name: _start(j, initial) for j in robot.joints if j.mimic is None}
    poses = forward_kinematics(robot, resolve_mimics(robot, free))
    transforms: dict[str, Transform] = {}
    for joint in missing:
        step = np.linalg.inv(poses[joint.parent]) @ poses[joint.child]
        x, y, z = step[:3, 3].tolist()
        qx, qy, qz, qw = quaternion_from_rpy(rpy_from_rotation(step[:3, :3])).tolist()
        parent = places[joint.parent]
        pose = RigidTransform((x, y, z), (qx, qy, qz, qw))
        transforms[places[joint.child]] = Transform(parent, pose)
    return transforms


def unknown_joints(robot: Robot, places: Mapping[str, str], known: Container[str]) -> list[str]:
    """Return the moving joints that /tf has no transform for."""
    return [
        joint.name
        for joint in robot.joints
        if joint.type is not JointType.FIXED and places[joint.child] not in known
    ]


def _start(joint: Joint, initial: Mapping[str, float]) -> float:
    position = initial.get(joint.name, 0.0)
    if joint.limit is not None and joint.type.needs_limit:
        position = min(max(position, joint.limit.lower), joint.limit.upper)
    return position if math.isfinite(position) else 0.0
