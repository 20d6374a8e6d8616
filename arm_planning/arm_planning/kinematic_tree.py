"""A robot's links and joints as a MuJoCo specification without shapes.

Collision checks add shapes to it; kinematics compile it as it is.
"""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_description.transforms import wxyz_from_rpy
from arm_description.urdf.robot import Joint, Robot
from arm_planning.errors import InvalidRequestError
from arm_planning.robot.model import JointPositions

Array = NDArray[np.float64]

MAX_LINKS = 1000
"""MuJoCo takes 1023 bodies, and works for minutes before it refuses more."""


@dataclass(frozen=True, slots=True)
class KinematicTree:
    """A specification to add shapes to and to compile, and where its parts stand.

    After compiling, `bodies[link].id` and `joints[joint].id` are indices in the compiled model.
    MuJoCo's names are left free: a link may be called `world`, which MuJoCo keeps for its own.

    Attributes:
        spec: the specification; the world's frame is the root link's.
        bodies: the body of each link, in tree order.
        joints: the joint of each scalar URDF joint, mimic joints included, in tree order.
    """

    spec: mujoco.MjSpec
    bodies: Mapping[str, mujoco.MjsBody]
    joints: Mapping[str, mujoco.MjsJoint]


@dataclass(frozen=True, slots=True, eq=False)
class PositionMap:
    """Positions of joints as a function of those that vary: matrix @ q + constant.

    Attributes:
        matrix: one row a joint, one column a varying joint, (m, n).
        constant: positions when all varying joints are at 0, (m,), rad or m.
    """

    matrix: Array
    constant: Array

    @property
    def is_identity(self) -> bool:
        """Whether the joints are those that vary, in the same order."""
        matrix = self.matrix
        return np.array_equal(matrix, np.eye(matrix.shape[1])) and not self.constant.any()

    def __call__(self, q: Array) -> Array:
        """Return the positions of all joints, (m,), for those that vary, (n,)."""
        return self.matrix @ q + self.constant

    def of_many(self, states: Array) -> Array:
        """Return the positions of all joints, (k, m), in states of those that vary, (k, n)."""
        return states @ self.matrix.T + self.constant


def kinematic_tree(
    robot: Robot,
    tips: Collection[str] | None = None,
    built_in: JointPositions = MappingProxyType({}),
) -> KinematicTree:
    """Return the bodies and joints of a robot.

    Floating and planar joints stay at their origin, as in `arm_description.forward_kinematics`.

    Args:
        robot: the robot.
        tips: the links to keep, with everything between them and the root; None for all.
        built_in: positions of scalar joints that do not move: they get no joint.

    Raises:
        PlanningError: the robot has too many links.
    """
    if len(robot.links) > MAX_LINKS:
        raise InvalidRequestError(
            f"robot '{robot.name}' has {len(robot.links)} links; planning takes {MAX_LINKS}"
        )
    spec = mujoco.MjSpec()
    root = spec.worldbody.add_body()
    bodies, joints = {robot.root: root}, dict[str, mujoco.MjsJoint]()
    kept = None if tips is None else _links_above(robot, tips)
    for joint in robot.joints_in_tree_order:
        if kept is not None and joint.child not in kept:
            continue
        body = bodies[joint.parent].add_body(
            pos=joint.origin.xyz, quat=wxyz_from_rpy(joint.origin.rpy)
        )
        bodies[joint.child] = body
        if joint.name in built_in:
            _displace(body, joint, built_in[joint.name])
        elif joint.type.is_scalar:
            joints[joint.name] = _add_joint(body, joint)
    return KinematicTree(spec, bodies, joints)


def position_map(
    robot: Robot, joints: Sequence[str], varying: Sequence[str], positions: JointPositions
) -> PositionMap:
    """Return the positions of joints as a function of those that vary.

    Args:
        robot: the robot.
        joints: names of the joints to place, m of them; mimic joints follow their leaders.
        varying: names of the joints that vary, n of them.
        positions: positions of the others; a joint without one is at 0.
    """
    column = {name: index for index, name in enumerate(varying)}
    matrix, constant = np.zeros((len(joints), len(varying))), np.zeros(len(joints))
    known = {*varying, *positions}
    for row, name in enumerate(joints):
        rule = robot.leader_of(name, known)
        if rule.joint in column:
            matrix[row, column[rule.joint]] = rule.multiplier
            constant[row] = rule.offset
        else:
            constant[row] = rule.position(positions.get(rule.joint, 0.0))
    return PositionMap(matrix, constant)


def _add_joint(body: mujoco.MjsBody, joint: Joint) -> mujoco.MjsJoint:
    # MuJoCo demands mass of what moves; kinematics do not depend on it.
    body.mass, body.inertia, body.explicitinertial = 1.0, (1.0, 1.0, 1.0), True
    kind = mujoco.mjtJoint.mjJNT_SLIDE if joint.type.slides else mujoco.mjtJoint.mjJNT_HINGE
    return body.add_joint(type=kind, axis=joint.axis)


def _displace(body: mujoco.MjsBody, joint: Joint, position: float) -> None:
    axis = np.asarray(joint.axis)
    if joint.type.slides:
        body.pos = body.pos + joint.origin.matrix()[:3, :3] @ axis * position
        return
    turn, quaternion = np.zeros(4), np.zeros(4)
    mujoco.mju_axisAngle2Quat(turn, axis, position)
    mujoco.mju_mulQuat(quaternion, body.quat, turn)
    body.quat = quaternion


def _links_above(robot: Robot, tips: Collection[str]) -> set[str]:
    """Return links and all that carry them."""
    parent = {joint.child: joint.parent for joint in robot.joints}
    kept: set[str] = set()
    for tip in tips:
        link: str | None = tip
        while link is not None and link not in kept:
            kept.add(link)
            link = parent.get(link)
    return kept
