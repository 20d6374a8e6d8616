"""The straight motion from one pose to another: the position along a line, the rotation evenly."""

import math
from dataclasses import dataclass

from arm_node.rigid_transform import Quaternion, RigidTransform, quaternion_product

SMALL_RAD = 1e-9
"""A turn below which the rotation is constant."""


@dataclass(frozen=True, slots=True)
class PoseLine:
    """A straight motion of a frame; its rotation is about one axis (slerp, Shoemake 1985).

    Attributes:
        start: the pose at share 0.
        end: the pose at share 1.
    """

    start: RigidTransform
    end: RigidTransform

    @property
    def length_m(self) -> float:
        """Distance between the positions."""
        return math.dist(self.start.position, self.end.position)

    @property
    def angle_rad(self) -> float:
        """Angle between the rotations, 0 to pi."""
        x, y, z, w = self._turn()
        return 2.0 * math.atan2(math.hypot(x, y, z), w)

    def at(self, share: float) -> RigidTransform:
        """Return the pose at a share of the way, 0 to 1."""
        x, y, z = (
            a + share * (b - a) for a, b in zip(self.start.position, self.end.position, strict=True)
        )
        return RigidTransform((x, y, z), self._rotation(share))

    def _rotation(self, share: float) -> Quaternion:
        x, y, z, w = self._turn()
        sine = math.hypot(x, y, z)
        half = math.atan2(sine, w)
        if half < SMALL_RAD:
            return self.start.rotation
        factor = math.sin(share * half) / sine
        turned = (factor * x, factor * y, factor * z, math.cos(share * half))
        return quaternion_product(turned, self.start.rotation)

    def _turn(self) -> Quaternion:
        """Return the rotation from start to end, the short way round."""
        x, y, z, w = self.start.rotation
        turn = quaternion_product(self.end.rotation, (-x, -y, -z, w))
        if turn[3] >= 0.0:
            return turn
        a, b, c, d = turn
        return (-a, -b, -c, -d)
