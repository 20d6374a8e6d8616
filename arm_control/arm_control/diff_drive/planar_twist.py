"""How fast a robot moves on the floor."""

from dataclasses import dataclass
from math import isfinite


@dataclass(frozen=True, slots=True)
class PlanarTwist:
    """A speed forwards in m/s and one of turning to the left in rad/s."""

    linear: float = 0.0
    angular: float = 0.0

    @property
    def is_finite(self) -> bool:
        """Whether both are numbers to drive by."""
        return isfinite(self.linear) and isfinite(self.angular)
