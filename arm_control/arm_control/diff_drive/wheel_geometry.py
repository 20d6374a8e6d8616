"""How the wheels of a differential drive and the robot's own motion belong together."""

from dataclasses import dataclass

from arm_control.diff_drive.planar_twist import PlanarTwist


@dataclass(frozen=True, slots=True)
class WheelGeometry:
    """The sizes that count, all in m: between the rows of wheels, and of the wheels."""

    separation: float
    left_radius: float
    right_radius: float

    def wheel_speeds(self, twist: PlanarTwist) -> tuple[float, float]:
        """Return how fast the left and the right wheels turn, in rad/s."""
        sideways = twist.angular * self.separation / 2
        return (
            (twist.linear - sideways) / self.left_radius,
            (twist.linear + sideways) / self.right_radius,
        )

    def motion(self, left: float, right: float) -> tuple[float, float]:
        """Return distance and turn, in m and rad, for angles by which the wheels turned, in rad.

        Speeds of the wheels give the robot's speeds likewise.
        """
        left_way, right_way = left * self.left_radius, right * self.right_radius
        return (left_way + right_way) / 2, (right_way - left_way) / self.separation
