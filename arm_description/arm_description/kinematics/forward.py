"""Forward kinematics: the poses of all links from the joints' positions."""

import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from arm_description.errors import KinematicsError
from arm_description.transforms import rotation_about, transform
from arm_description.urdf.robot import Joint, Robot
from arm_node.names import listing

Positions = Mapping[str, float]
"""Position by joint name: rad for revolute and continuous joints, m for prismatic ones."""


def forward_kinematics(robot: Robot, positions: Positions) -> dict[str, NDArray[np.float64]]:
    """Return the pose of every link in the root link's frame as (4, 4) transforms, by name.

    A joint without a position is at 0, or follows the joint that it mimics. Floating and planar
    joints stay at their origin, because one number cannot place them.

    Raises:
        KinematicsError: a position is not finite, or its joint does not exist.
    """
    _check(robot, positions)
    every = resolve_mimics(robot, positions)
    poses = {robot.root: np.eye(4)}
    for joint in robot.joints_in_tree_order:
        motion = _motion(joint, every.get(joint.name, 0.0))
        poses[joint.child] = poses[joint.parent] @ joint.origin.matrix() @ motion
    return poses


def resolve_mimics(robot: Robot, positions: Positions) -> dict[str, float]:
    """Return the positions with those of mimic joints added, over chains of any length.

    A given position of a mimic joint is kept; a leader without a position is at 0.
    """
    result = dict(positions)
    for joint in robot.joints:
        if joint.mimic is not None and joint.name not in positions:
            rule = robot.leader_of(joint.name, positions)
            result[joint.name] = rule.position(positions.get(rule.joint, 0.0))
    return result


def _check(robot: Robot, positions: Positions) -> None:
    known = {joint.name for joint in robot.joints}
    for name, position in positions.items():
        if name not in known:
            raise KinematicsError(f"no joint '{name}'; the robot has {listing(sorted(known))}")
        if not math.isfinite(position):
            raise KinematicsError(f"joint '{name}' has a position that is not finite: {position}")


def _motion(joint: Joint, position: float) -> NDArray[np.float64]:
    if joint.type.turns:
        return transform(rotation_about(joint.axis, position), (0.0, 0.0, 0.0))
    if joint.type.slides:
        return transform(np.eye(3), np.multiply(joint.axis, position))
    return np.eye(4)
