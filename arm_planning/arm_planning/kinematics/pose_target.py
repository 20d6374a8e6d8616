"""Poses that users ask for, checked: position and unit quaternion."""

import math

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_node.rigid_transform import RigidTransform
from arm_planning.errors import InvalidGoalError
from arm_planning.scene.object_checks import UNIT, pose_problem, vector_problem

Array = NDArray[np.float64]


def checked_pose(pose: RigidTransform | Array) -> tuple[Array, Array]:
    """Return the position, (3,), and the unit quaternion w, x, y, z, (4,), of a pose.

    Args:
        pose: the pose; an array is a homogeneous transform, (4, 4).

    Raises:
        PlanningError: INVALID_GOAL_CONSTRAINTS: a number is not finite, or the rotation is none.
    """
    if isinstance(pose, RigidTransform):
        if problem := pose_problem(pose, "the target"):
            raise InvalidGoalError(problem)
        x, y, z, w = pose.rotation
        return np.array(pose.position), np.array((w, x, y, z)) / math.hypot(w, x, y, z)
    matrix = np.asarray(pose, dtype=float)
    if matrix.shape != (4, 4):
        raise InvalidGoalError(f"a pose is a transform of shape (4, 4), not {matrix.shape}")
    position, rotation = matrix[:3, 3].copy(), matrix[:3, :3].reshape(9)
    if problem := vector_problem(position.tolist(), "the position of the target"):
        raise InvalidGoalError(problem)
    if not np.isfinite(rotation).all():
        raise InvalidGoalError("the target's rotation has a number that is not finite")
    quaternion, back = np.empty(4), np.empty(9)
    mujoco.mju_mat2Quat(quaternion, rotation)
    # The matrix of a quaternion is a rotation; the given one is if it is the same.
    mujoco.mju_quat2Mat(back, quaternion)
    if np.abs(back - rotation).max() > UNIT:
        raise InvalidGoalError("the target's rotation matrix is not orthonormal and right-handed")
    return position, quaternion


def as_rigid_transform(matrix: Array) -> RigidTransform:
    """Return the pose of a homogeneous transform, (4, 4)."""
    quaternion = np.empty(4)
    mujoco.mju_mat2Quat(quaternion, np.ascontiguousarray(matrix[:3, :3]).ravel())
    w, x, y, z = quaternion.tolist()
    px, py, pz = matrix[:3, 3].tolist()
    return RigidTransform((px, py, pz), (x, y, z, w))
