"""Where a robot is by how its wheels turned."""

from collections import deque

from arm_control.diff_drive.planar_pose import PlanarPose
from arm_control.diff_drive.planar_twist import PlanarTwist


class Odometry:
    """Adds up the arcs driven, and smooths the speeds on them.

    Attributes:
        pose: seen from where it began.
        twist: mean over the last arcs, in m/s and rad/s.
    """

    def __init__(self, window: int = 10) -> None:
        """Begin at the origin.

        Args:
            window: how many arcs the mean of the speeds is taken over, at least 1.
        """
        self.pose = PlanarPose()
        self.twist = PlanarTwist()
        self._speeds: deque[tuple[float, float]] = deque(maxlen=window)

    def move(self, distance: float, turn: float, period_s: float) -> None:
        """Add an arc.

        Args:
            distance: along it, in m.
            turn: of the heading, in rad.
            period_s: what it took; more than 0.
        """
        self.pose = self.pose.moved(distance, turn)
        self._speeds.append((distance / period_s, turn / period_s))
        count = len(self._speeds)
        self.twist = PlanarTwist(
            sum(linear for linear, _ in self._speeds) / count,
            sum(angular for _, angular in self._speeds) / count,
        )

    def halt(self) -> None:
        """Forget the speeds; the pose stays."""
        self._speeds.clear()
        self.twist = PlanarTwist()
