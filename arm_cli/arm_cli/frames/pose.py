"""Rigid transforms as a translation and a unit quaternion x, y, z, w."""

import math
from dataclasses import dataclass

Vector = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]


@dataclass(frozen=True, slots=True)
class Pose:
    """Where one frame is in another.

    Attributes:
        translation: [m].
        quaternion: x, y, z, w, of length 1.
    """

    translation: Vector = (0.0, 0.0, 0.0)
    quaternion: Quaternion = (0.0, 0.0, 0.0, 1.0)

    def matrix(self) -> tuple[tuple[float, ...], ...]:
        """Return the rows of the homogeneous matrix, shape (4, 4)."""
        x, y, z, w = self.quaternion
        tx, ty, tz = self.translation
        return (
            (1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w), tx),
            (2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w), ty),
            (2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y), tz),
            (0.0, 0.0, 0.0, 1.0),
        )

    def then(self, inner: "Pose") -> "Pose":
        """Return the pose of a frame that is at `inner` in the frame at this pose."""
        return Pose(self._out(inner.translation), _product(self.quaternion, inner.quaternion))

    def inverse(self) -> "Pose":
        """Return where the outer frame is in the inner one."""
        x, y, z, w = self.quaternion
        turned = Pose(quaternion=(-x, -y, -z, w))
        tx, ty, tz = turned._out(self.translation)
        return Pose((-tx, -ty, -tz), turned.quaternion)

    def rpy(self) -> tuple[float, float, float]:
        """Return roll, pitch and yaw [rad], about the fixed x, y and z axes."""
        x, y, z, w = self.quaternion
        sine = 2 * (w * y - z * x)
        return (
            math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y)),
            math.asin(min(1.0, max(-1.0, sine))),
            math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)),
        )

    def _out(self, point: Vector) -> Vector:
        """Return a point of the inner frame in the outer one."""
        px, py, pz = point
        x, y, z = (a * px + b * py + c * pz + d for a, b, c, d in self.matrix()[:3])
        return (x, y, z)


def _product(a: Quaternion, b: Quaternion) -> Quaternion:
    (ax, ay, az, aw), (bx, by, bz, bw) = a, b
    return (
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    )
