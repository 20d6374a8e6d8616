"""Poses as people write them."""

from collections.abc import Sequence
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from arm_description.transforms import rotation_from_quaternion, transform
from arm_description.urdf.robot import Pose
from arm_sim.errors import CallError

Matrix = NDArray[np.float64]
AnyPose: TypeAlias = "Pose | ArrayLike | Sequence[float] | None"
"""x y z; x y z roll pitch yaw; x y z and a quaternion x y z w; a (4, 4) matrix; a `Pose`; None for
the origin. In m and rad."""


def pose_matrix(pose: AnyPose) -> Matrix:
    """Return a pose as a (4, 4) matrix.

    Raises:
        CallError: it is not a pose.
    """
    if pose is None:
        return np.eye(4)
    if isinstance(pose, Pose):
        return pose.matrix()
    try:
        values = np.asarray(pose, dtype=np.float64)
    except (TypeError, ValueError):
        values = np.empty(0)
    if not np.isfinite(values).all():
        raise _refusal(pose)
    if values.shape == (4, 4):
        return _rigid(values, pose)
    if values.shape == (3,):
        return Pose((values[0], values[1], values[2])).matrix()
    if values.shape == (6,):
        return Pose((values[0], values[1], values[2]), (values[3], values[4], values[5])).matrix()
    if values.shape == (7,):
        return _of_quaternion(values, pose)
    raise _refusal(pose)


def _rigid(values: Matrix, pose: AnyPose) -> Matrix:
    rotation = values[:3, :3]
    is_rotation = np.allclose(rotation @ rotation.T, np.eye(3), atol=1e-6)
    if not (is_rotation and np.linalg.det(rotation) > 0 and (values[3] == (0, 0, 0, 1)).all()):
        raise _refusal(pose)
    return values.copy()


def _of_quaternion(values: Matrix, pose: AnyPose) -> Matrix:
    length = float(np.linalg.norm(values[3:]))
    if length < 1e-6:
        raise _refusal(pose)
    return transform(rotation_from_quaternion(values[3:] / length), values[:3])


def _refusal(pose: AnyPose) -> CallError:
    return CallError(
        "a pose is x y z, x y z roll pitch yaw, x y z with a quaternion x y z w, or a (4, 4) "
        f"matrix, of finite numbers; not {pose!r}"
    )
