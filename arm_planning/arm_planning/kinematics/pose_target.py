"""Poses that users ask for, checked: position and unit quaternion."""

import math

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_node.rigid_transform import RigidTransform
from arm_planning.errors import InvalidGoalError

Array = NDArray[np.float64]

FARTHEST_M = 1e6
"""Beyond it, squares of numbers lose what matters, and at last overflow."""
UNIT_WITHIN = 1e-3
"""How far a quaternion's length, or a number of a rotation matrix, may be off."""


def checked_pose(pose: RigidTransform | Array) -> tuple[Array, Array]:
    """Return the position, (3,), and the unit quaternion w, x, y, z, (4,), of a pose.

    Args:
        pose: the pose; an array is a homogeneous transform, (4, 4).

    Raises:
        PlanningError: INVALID_GOAL_CONSTRAINTS: a number is not finite, or the rotation is none.
    """
    if isinstance(pose, RigidTransform):
        x, y, z, w = pose.rotation
        return _checked_position(np.array(pose.position)), _checked_quaternion(
            np.array((w, x, y, z))
        )
    matrix = np.asarray(pose, dtype=float)
    if matrix.shape != (4, 4):
        raise InvalidGoalError(f"a pose is a transform of shape (4, 4), not {matrix.shape}")
    position, rotation = _checked_position(matrix[:3, 3].copy()), matrix[:3, :3].reshape(9)
    if not np.isfinite(rotation).all():
        raise InvalidGoalError("the target's rotation has a number that is not finite")
    quaternion, back = np.empty(4), np.empty(9)
    mujoco.mju_mat2Quat(quaternion, rotation)
    # The matrix of a quaternion is a rotation; the given one is if it is the same.
    mujoco.mju_quat2Mat(back, quaternion)
    if np.abs(back - rotation).max() > UNIT_WITHIN:
        raise InvalidGoalError("the target's rotation matrix is not orthonormal and right-handed")
    return position, quaternion


def as_rigid_transform(matrix: Array) -> RigidTransform:
    """Return the pose of a homogeneous transform, (4, 4)."""
    quaternion = np.empty(4)
    mujoco.mju_mat2Quat(quaternion, np.ascontiguousarray(matrix[:3, :3]).ravel())
    w, x, y, z = quaternion.tolist()
    px, py, pz = matrix[:3, 3].tolist()
    return RigidTransform((px, py, pz), (x, y, z, w))


def _checked_position(position: Array) -> Array:
    if not np.isfinite(position).all():
        raise InvalidGoalError(
            f"the target's position has a number that is not finite: {_text(position)}"
        )
    if np.abs(position).max() > FARTHEST_M:
        raise InvalidGoalError(
            f"the target's position {_text(position)} is more than {FARTHEST_M / 1e3:g} km away"
        )
    return position


def _checked_quaternion(wxyz: Array) -> Array:
    w, x, y, z = wxyz.tolist()
    if not np.isfinite(wxyz).all():
        raise InvalidGoalError(
            f"the target's quaternion has a number that is not finite: {_text((x, y, z, w))}"
        )
    length = math.hypot(w, x, y, z)
    if abs(length - 1.0) > UNIT_WITHIN:
        raise InvalidGoalError(
            f"the target's quaternion (x, y, z, w) = {_text((x, y, z, w))} has length "
            f"{length:.3g} instead of 1"
        )
    return wxyz / length


def _text(numbers: Array | tuple[float, ...]) -> str:
    return "(" + ", ".join(f"{number:g}" for number in numbers) + ")"
