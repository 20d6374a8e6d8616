"""Forward kinematics: where every link is, from the joints' positions."""

import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from arm_description.errors import KinematicsError
from arm_description.names import listing
from arm_description.robot import Joint, Robot
from arm_description.transforms import rotation_about, transform

Positions = Mapping[str, float]
"""Position by joint name: rad for revolute and continuous joints, m for prismatic ones."""


def forward_kinematics(robot: Robot, positions: Positions) -> dict[str, NDArray[np.float64]]:
    """Return the pose of every link in the root link's frame as (4, 4) transforms, by name.

    A joint without a position is at 0, or where what it mimics puts it. Floating and planar
    joints stay at their origin: one number cannot place them.

    Raises:
        KinematicsError: a position for a joint that does not exist, or that is not finite.
    """
    _check(robot, positions)
    every = resolve_mimics(robot, positions)
    poses = {robot.root: np.eye(4)}
    for joint in robot.joints_in_tree_order:
        motion = _motion(joint, every.get(joint.name, 0.0))
        poses[joint.child] = poses[joint.parent] @ joint.origin.matrix() @ motion
    return poses


def resolve_mimics(robot: Robot, positions: Positions) -> dict[str, float]:
    """Return the positions with those of the mimicking joints added, over chains of any length.

    A position that is given stands, also for a mimicking joint; a leader that has none is at 0.
    """
    result = dict(positions)
    for joint in robot.joints:
        waiting: list[Joint] = []
        follower = joint
        while follower.mimic is not None and follower.name not in result:
            waiting.append(follower)
            follower = robot.joint(follower.mimic.joint)
        position = result.get(follower.name, 0.0)
        for follower in reversed(waiting):
            assert follower.mimic is not None
            position = follower.mimic.multiplier * position + follower.mimic.offset
            result[follower.name] = position
    return result


def _check(robot: Robot, positions: Positions) -> None:
    known = {joint.name for joint in robot.joints}
    for name, position in positions.items():
        if name not in known:
            raise KinematicsError(f"no joint '{name}'; the robot has {listing(sorted(known))}")
        if not math.isfinite(position):
            raise KinematicsError(f"joint '{name}' has the position {position}, not a number")


def _motion(joint: Joint, position: float) -> NDArray[np.float64]:
    if joint.type in ("revolute", "continuous"):
        return transform(rotation_about(joint.axis, position), (0.0, 0.0, 0.0))
    if joint.type == "prismatic":
        return transform(np.eye(3), np.multiply(joint.axis, position))
    return np.eye(4)
