"""Rotations and rigid transforms in URDF's conventions.

Roll, pitch and yaw rotate about the fixed axes x, y, z in this order, so R = Rz(yaw) Ry(pitch)
Rx(roll). Quaternions are (x, y, z, w), as in geometry_msgs. Angles in rad, lengths in m.
"""

from collections.abc import Sequence
from math import cos, sin

import numpy as np
from numpy.typing import NDArray

from arm_node.rigid_transform import rpy_from_rows

Array = NDArray[np.float64]
_WXYZ = np.array([3, 0, 1, 2])


def rotation_from_rpy(rpy: Sequence[float]) -> Array:
    """Return the (3, 3) rotation of roll, pitch, yaw."""
    roll, pitch, yaw = rpy
    sr, cr, sp, cp, sy, cy = sin(roll), cos(roll), sin(pitch), cos(pitch), sin(yaw), cos(yaw)
    return np.array(
        [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ]
    )


def rpy_from_rotation(rotation: Array) -> tuple[float, float, float]:
    """Return roll, pitch, yaw of a (3, 3) rotation; see `rpy_from_rows`."""
    return rpy_from_rows(rotation.tolist())


def rotation_about(axis: Sequence[float], angle: float) -> Array:
    """Return the (3, 3) rotation by an angle about a unit axis (Rodrigues' formula)."""
    x, y, z = axis
    s, c = sin(angle), cos(angle)
    t = 1.0 - c
    return np.array(
        [
            [t * x * x + c, t * x * y - s * z, t * x * z + s * y],
            [t * x * y + s * z, t * y * y + c, t * y * z - s * x],
            [t * x * z - s * y, t * y * z + s * x, t * z * z + c],
        ]
    )


def transform(rotation: Array, translation: Sequence[float] | Array) -> Array:
    """Return the (4, 4) homogeneous transform of a (3, 3) rotation and a translation (3,)."""
    result = np.eye(4)
    result[:3, :3] = rotation
    result[:3, 3] = translation
    return result


def quaternion_from_rpy(rpy: Sequence[float]) -> Array:
    """Return the unit quaternion (x, y, z, w) of roll, pitch, yaw."""
    roll, pitch, yaw = (angle / 2.0 for angle in rpy)
    sr, cr, sp, cp, sy, cy = sin(roll), cos(roll), sin(pitch), cos(pitch), sin(yaw), cos(yaw)
    return np.array(
        [
            sr * cp * cy - cr * sp * sy,
            cr * sp * cy + sr * cp * sy,
            cr * cp * sy - sr * sp * cy,
            cr * cp * cy + sr * sp * sy,
        ]
    )


def rotation_from_quaternion(quaternion: Array) -> Array:
    """Return the (3, 3) rotation of a unit quaternion (x, y, z, w)."""
    x, y, z, w = quaternion.tolist()
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


def wxyz_from_rpy(rpy: Sequence[float]) -> Array:
    """Return the quaternion (w, x, y, z) of roll, pitch, yaw, in MuJoCo's order."""
    return quaternion_from_rpy(rpy)[_WXYZ]
