"""Where a robot stands on the floor, and how it looks."""

from dataclasses import dataclass
from math import cos, sin


@dataclass(frozen=True, slots=True)
class PlanarPose:
    """A place in the plane, in m, and a heading in rad that counts full turns."""

    x: float = 0.0
    y: float = 0.0
    heading: float = 0.0

    def moved(self, distance: float, turn: float) -> "PlanarPose":
        """Return the pose at the end of an arc.

        Args:
            distance: along the arc, in m; negative backwards.
            turn: of the heading on the way, in rad.
        """
        # The chord of an arc lies half-way between both headings. As the turn goes to nothing this
        # becomes the second-order Runge-Kutta step, so no case needs a formula of its own.
        half = turn / 2
        chord = distance * (sin(half) / half if half else 1.0)
        direction = self.heading + half
        return PlanarPose(
            self.x + chord * cos(direction), self.y + chord * sin(direction), self.heading + turn
        )
