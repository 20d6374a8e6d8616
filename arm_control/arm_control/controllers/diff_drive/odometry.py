"""Converts between wheel speeds and a robot's planar twist, and integrates its pose."""

from collections import deque
from dataclasses import dataclass
from math import cos, isfinite, sin
from typing import Any

from arm_control.state.attributes import load_attributes, save_attributes


@dataclass(frozen=True, slots=True)
class PlanarTwist:
    """A forward velocity in m/s and a yaw rate (positive to the left) in rad/s."""

    linear: float = 0.0
    angular: float = 0.0

    @property
    def is_finite(self) -> bool:
        """Whether both are finite."""
        return isfinite(self.linear) and isfinite(self.angular)


@dataclass(frozen=True, slots=True)
class PlanarPose:
    """A position in the plane, in m, and a heading in rad that is not wrapped."""

    x: float = 0.0
    y: float = 0.0
    heading: float = 0.0

    def moved(self, distance: float, turn: float) -> "PlanarPose":
        """Return the pose after an arc: its distance in m, negative backwards, its turn in rad."""
        # The direction of an arc's chord is the mean of both headings. For a small turn this
        # becomes the second-order Runge-Kutta step, so straight motion needs no formula of its own.
        half = turn / 2
        chord = distance * (sin(half) / half if half else 1.0)
        direction = self.heading + half
        return PlanarPose(
            self.x + chord * cos(direction), self.y + chord * sin(direction), self.heading + turn
        )


@dataclass(frozen=True, slots=True)
class WheelGeometry:
    """Wheel separation and wheel radii, in m."""

    separation: float
    left_radius: float
    right_radius: float

    def wheel_speeds(self, twist: PlanarTwist) -> tuple[float, float]:
        """Return the speeds of the left and right wheels, in rad/s."""
        sideways = twist.angular * self.separation / 2
        return (
            (twist.linear - sideways) / self.left_radius,
            (twist.linear + sideways) / self.right_radius,
        )

    def motion(self, left: float, right: float) -> tuple[float, float]:
        """Return distance and turn, in m and rad, from the wheels' rotations, in rad.

        Likewise, the speeds of the wheels give the speeds of the robot.
        """
        left_distance, right_distance = left * self.left_radius, right * self.right_radius
        turn = (right_distance - left_distance) / self.separation
        return (left_distance + right_distance) / 2, turn


class Odometry:
    """Integrates the arcs driven, and averages the speeds.

    Attributes:
        pose: relative to the starting pose.
        twist: mean over the last arcs, in m/s and rad/s.
    """

    def __init__(self, window: int = 10) -> None:
        """Start at the origin; the speeds are averaged over `window` arcs, at least 1."""
        self.pose = PlanarPose()
        self.twist = PlanarTwist()
        self._speeds: deque[tuple[float, float]] = deque(maxlen=window)

    def move(self, distance: float, turn: float, period_s: float) -> None:
        """Add an arc: its distance in m, its change of heading in rad, its duration, above 0."""
        self.pose = self.pose.moved(distance, turn)
        self._speeds.append((distance / period_s, turn / period_s))
        count = len(self._speeds)
        self.twist = PlanarTwist(
            sum(linear for linear, _ in self._speeds) / count,
            sum(angular for _, angular in self._speeds) / count,
        )

    def save_state(self) -> dict[str, Any]:
        """Return the pose, and the speeds that are averaged."""
        return save_attributes(self)

    def load_state(self, state: dict[str, Any]) -> None:
        """Set the pose, and the speeds that are averaged."""
        load_attributes(self, state)

    def halt(self) -> None:
        """Forget the speeds; the pose stays."""
        self._speeds.clear()
        self.twist = PlanarTwist()
