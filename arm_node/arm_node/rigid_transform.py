"""Rotations and poses of single frames, in plain Python.

For one frame at a time tuples are faster than NumPy arrays, and need no import.
`arm_description.transforms` converts from URDF's roll, pitch and yaw, and computes with arrays.
"""

from collections.abc import Sequence
from math import atan2, hypot

from arm_node.frozen import frozen

Vector = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]
"""A unit quaternion (x, y, z, w), as in geometry_msgs."""

GIMBAL_LOCK = 1e-9
"""Cosine of the pitch below which roll and yaw rotate about the same axis."""


@frozen
class RigidTransform:
    """The pose of one frame in another; by default they coincide.

    Attributes:
        position: x, y, z, in m.
        rotation: unit quaternion.
    """

    position: Vector = (0.0, 0.0, 0.0)
    rotation: Quaternion = (0.0, 0.0, 0.0, 1.0)

    def then(self, inner: "RigidTransform") -> "RigidTransform":
        """Return the pose of a frame that is at `inner` in the frame at this pose."""
        x, y, z = rotated(self.rotation, inner.position)
        px, py, pz = self.position
        product = quaternion_product(self.rotation, inner.rotation)
        return RigidTransform((px + x, py + y, pz + z), product)

    def inverse(self) -> "RigidTransform":
        """Return the pose of the outer frame in the inner one."""
        x, y, z, w = self.rotation
        conjugate = (-x, -y, -z, w)
        px, py, pz = rotated(conjugate, self.position)
        return RigidTransform((-px, -py, -pz), conjugate)

    def matrix(self) -> tuple[tuple[float, ...], ...]:
        """Return the rows of the homogeneous matrix, shape (4, 4)."""
        x, y, z, w = self.rotation
        px, py, pz = self.position
        return (
            (1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w), px),
            (2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w), py),
            (2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y), pz),
            (0.0, 0.0, 0.0, 1.0),
        )

    def rpy(self) -> Vector:
        """Return roll, pitch and yaw in rad; see `rpy_from_rows`."""
        return rpy_from_rows(self.matrix())


def quaternion_product(first: Sequence[float], second: Sequence[float]) -> Quaternion:
    """Return the quaternion that rotates by `second`, then by `first`."""
    x, y, z, w = first
    a, b, c, d = second
    return (
        w * a + x * d + y * c - z * b,
        w * b - x * c + y * d + z * a,
        w * c + x * b - y * a + z * d,
        w * d - x * a - y * b - z * c,
    )


def rotated(rotation: Quaternion, vector: Vector) -> Vector:
    """Return a vector rotated by a unit quaternion."""
    x, y, z, w = rotation
    a, b, c = vector
    # v + 2 w (u x v) + 2 u x (u x v), with u the quaternion's vector part.
    p, q, r = 2 * (y * c - z * b), 2 * (z * a - x * c), 2 * (x * b - y * a)
    return (
        a + w * p + y * r - z * q,
        b + w * q + z * p - x * r,
        c + w * r + x * q - y * p,
    )


def rpy_from_rows(rows: Sequence[Sequence[float]]) -> Vector:
    """Return roll, pitch and yaw in rad, about the fixed x, y and z axes.

    The pitch is in [-pi/2, pi/2]; in gimbal lock the roll is 0. The rows are those of a rotation
    matrix, or of a homogeneous one.
    """
    (r00, r01, *_), (r10, r11, *_), (r20, r21, r22, *_) = rows[:3]
    level = hypot(r00, r10)
    # Not -r20, which would give -0.0 for a level pose.
    pitch = atan2(0.0 - r20, level)
    if level < GIMBAL_LOCK:
        return 0.0, pitch, atan2(-r01, r11)
    return atan2(r21, r22), pitch, atan2(r10, r00)
