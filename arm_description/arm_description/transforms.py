"""Rotations and rigid transforms in URDF's conventions.

Roll, pitch and yaw turn about the fixed axes x, y, z in this order, so R = Rz(yaw) Ry(pitch)
Rx(roll). Quaternions are (x, y, z, w), as in geometry_msgs. Angles in rad, lengths in m.
"""

from collections.abc import Sequence
from math import atan2, cos, hypot, sin

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

UPRIGHT = 1e-9
"""Cosine of a pitch at which x points along the fixed z, and roll and yaw turn about one axis."""


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
    """Return roll, pitch, yaw of a (3, 3) rotation; roll is 0 where only its sum with yaw counts.

    The pitch is at most a quarter turn to both sides.
    """
    (r00, r01, _), (r10, r11, _), (r20, r21, r22) = rotation.tolist()
    level = hypot(r00, r10)
    pitch = atan2(-r20, level)
    if level < UPRIGHT:
        return 0.0, pitch, atan2(-r01, r11)
    return atan2(r21, r22), pitch, atan2(r10, r00)


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


def quaternion_product(first: Array, second: Array) -> Array:
    """Return the quaternion (x, y, z, w) that turns by `second`, then by `first`."""
    x, y, z, w = first
    a, b, c, d = second
    return np.array(
        [
            w * a + x * d + y * c - z * b,
            w * b - x * c + y * d + z * a,
            w * c + x * b - y * a + z * d,
            w * d - x * a - y * b - z * c,
        ]
    )
