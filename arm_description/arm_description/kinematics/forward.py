"""Forward kinematics: the poses of links, and the transforms between frames, from joint positions.

The transform of a joint that moves is an affine function of three numbers: its position, for the
translation of a prismatic joint, and the sine and cosine of half its position, for the rotation of
a revolute one. So all joints of a message are computed at once.
"""

import math
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from arm_description.errors import KinematicsError
from arm_description.transforms import (
    quaternion_from_rpy,
    rotation_about,
    rotation_from_rpy,
    transform,
)
from arm_description.urdf.robot import Joint, Robot
from arm_node.frozen import frozen
from arm_node.names import listing
from arm_node.rigid_transform import quaternion_product

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


Array = NDArray[np.float64]


@frozen
class Frame:
    """A child frame and its parent frame, by link name."""

    parent: str
    child: str


@frozen
class Motion:
    """The transforms that depend on one kind of joint state message.

    Joint k of m has the position `multiplier[k]` x position `source[k]` of the message +
    `offset[k]`.
    """

    frames: tuple[Frame, ...]
    source: NDArray[np.intp]
    multiplier: Array
    offset: Array
    constant: Array
    per_metre: Array
    per_sine: Array
    per_cosine: Array

    def transforms(self, positions: Array) -> Array:
        """Return (m, 7): x, y, z in m and the quaternion x, y, z, w of every frame.

        If a joint's position is not finite or overflows, its row is not finite either.

        Args:
            positions: positions (n,) in the order of the message, rad or m.
        """
        with np.errstate(over="ignore", invalid="ignore"):
            value = (self.multiplier * positions[self.source] + self.offset)[:, np.newaxis]
            half = value * 0.5
            return (
                self.constant
                + self.per_metre * value
                + self.per_sine * np.sin(half)
                + self.per_cosine * np.cos(half)
            )


class TransformTree:
    """The transforms of a robot's joints; floating joints have none, as in ROS 2."""

    def __init__(self, robot: Robot) -> None:
        """Compute everything that does not depend on the positions."""
        joints = robot.joints_in_tree_order
        static = [joint for joint in joints if joint.type.is_static]
        self.static_frames = tuple(Frame(joint.parent, joint.child) for joint in static)
        self.static_transforms = np.array([_origin(joint) for joint in static]).reshape(-1, 7)
        self._robot = robot
        self._moving = [joint for joint in joints if joint.type.is_scalar]

    def motion(self, names: Sequence[str]) -> Motion:
        """Return the transforms that depend on a message with these joints.

        A mimic joint moves with the nearest of its leaders that the message names, unless the
        message names the joint itself. Unknown names are ignored; of a repeated name the first one
        is used.
        """
        index = {name: i for i, name in reversed(list(enumerate(names)))}
        joints: list[Joint] = []
        rules: list[tuple[int, float, float]] = []
        for joint in self._moving:
            rule = self._rule(joint, index)
            if rule is not None:
                joints.append(joint)
                rules.append(rule)
        parts = np.array([_parts(joint) for joint in joints]).reshape(-1, 4, 7)
        return Motion(
            frames=tuple(Frame(joint.parent, joint.child) for joint in joints),
            source=np.array([source for source, _, _ in rules], dtype=np.intp),
            multiplier=np.array([multiplier for _, multiplier, _ in rules]),
            offset=np.array([offset for _, _, offset in rules]),
            constant=parts[:, 0],
            per_metre=parts[:, 1],
            per_sine=parts[:, 2],
            per_cosine=parts[:, 3],
        )

    def _rule(self, joint: Joint, index: dict[str, int]) -> tuple[int, float, float] | None:
        rule = self._robot.leader_of(joint.name, index)
        source = index.get(rule.joint)
        return None if source is None else (source, rule.multiplier, rule.offset)


def _origin(joint: Joint) -> Array:
    return np.concatenate((joint.origin.xyz, quaternion_from_rpy(joint.origin.rpy)))


def _parts(joint: Joint) -> Array:
    """Return a moving joint's rows (4, 7): constant, per metre, per sine, per cosine."""
    rows = np.zeros((4, 7))
    rows[0, :3] = joint.origin.xyz
    turned = quaternion_from_rpy(joint.origin.rpy)
    if joint.type.turns:
        rows[2, 3:] = quaternion_product(turned.tolist(), (*joint.axis, 0.0))
        rows[3, 3:] = turned
    else:
        rows[0, 3:] = turned
        rows[1, :3] = rotation_from_rpy(joint.origin.rpy) @ joint.axis
    return rows
