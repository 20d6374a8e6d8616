"""Converts between the velocities of four mecanum wheels and a robot's planar twist.

The rollers of each wheel are at 45 degrees to its axis; seen from above, those of the front left
wheel point from front left to rear right, as the X that the four wheels form. Then, with wheel
radius r and k the distance of a wheel's contact from the centre along x plus that along y:

    front_left  = (x - y - k yaw) / r        rear_left  = (x + y - k yaw) / r
    front_right = (x + y + k yaw) / r        rear_right = (x - y + k yaw) / r

Source: H. Taheri, B. Qiao, N. Ghaeminezhad, "Kinematic Model of a Four Mecanum Wheeled Mobile
Robot", International Journal of Computer Applications 113(3), 2015, equations 20 and 21.
"""

from dataclasses import dataclass
from math import cos, isfinite, sin

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

WHEELS = ("front_left", "front_right", "rear_right", "rear_left")
"""The order of the wheels in all arrays."""

_SIGNS = np.array([[1.0, -1.0, -1.0], [1.0, 1.0, 1.0], [1.0, -1.0, 1.0], [1.0, 1.0, -1.0]])
"""How x, y and yaw count in the velocity of each wheel."""


@dataclass(frozen=True, slots=True)
class MecanumTwist:
    """A twist in the plane: forward and left in m/s, yaw rate in rad/s."""

    x: float = 0.0
    y: float = 0.0
    yaw: float = 0.0

    @property
    def is_finite(self) -> bool:
        """Whether all three are finite numbers."""
        return isfinite(self.x) and isfinite(self.y) and isfinite(self.yaw)

    def rotated(self, angle: float) -> "MecanumTwist":
        """Return the twist in axes that are turned by -`angle` rad, about the same point."""
        c, s = cos(angle), sin(angle)
        return MecanumTwist(c * self.x - s * self.y, s * self.x + c * self.y, self.yaw)

    def at(self, x: float, y: float) -> "MecanumTwist":
        """Return the twist of the point (x, y) of the same rigid body, in m."""
        return MecanumTwist(self.x - self.yaw * y, self.y + self.yaw * x, self.yaw)


@dataclass(frozen=True, slots=True)
class MecanumGeometry:
    """Sizes of the base, and the pose of its base frame.

    Attributes:
        radius: of the wheels, in m.
        reach: distance of a wheel from the centre along x plus that along y, in m.
        base_x: x of the base frame's origin in the centre frame, in m.
        base_y: y of it, in m.
        base_yaw: the base frame's orientation in the centre frame, in rad.
    """

    radius: float
    reach: float
    base_x: float = 0.0
    base_y: float = 0.0
    base_yaw: float = 0.0

    def wheel_velocities(self, twist: MecanumTwist) -> Array:
        """Return the wheels' velocities in rad/s, shape (4,), for a twist of the base frame."""
        centre = twist.rotated(self.base_yaw).at(-self.base_x, -self.base_y)
        return _SIGNS @ (centre.x, centre.y, self.reach * centre.yaw) / self.radius

    def twist(self, velocities: Array) -> MecanumTwist:
        """Return the twist of the base frame for velocities of the wheels, shape (4,).

        Four velocities determine three numbers: this is their least-squares fit.
        """
        x, y, turn = (velocities @ _SIGNS * (self.radius / 4)).tolist()
        centre = MecanumTwist(x, y, turn / self.reach)
        return centre.at(self.base_x, self.base_y).rotated(-self.base_yaw)


@dataclass(slots=True)
class MecanumOdometry:
    """Integrates the wheels' motion to a pose in the odometry frame.

    Attributes:
        x: in m.
        y: in m.
        heading: in rad; counts full turns.
        twist: of the base frame in the last cycle.
    """

    x: float = 0.0
    y: float = 0.0
    heading: float = 0.0
    twist: MecanumTwist = MecanumTwist()

    def move(self, twist: MecanumTwist, period_s: float) -> None:
        """Add the motion of a constant twist during a period."""
        # The chord of the arc, halfway between the headings at its two ends.
        half = twist.yaw * period_s / 2
        chord = period_s * (sin(half) / half if half else 1.0)
        step = twist.rotated(self.heading + half)
        self.x += step.x * chord
        self.y += step.y * chord
        self.heading += 2 * half
        self.twist = twist
