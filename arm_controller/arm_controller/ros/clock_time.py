"""Clocks, read in seconds."""

from rclpy.clock import Clock
from rclpy.clock_type import ClockType

NANOSECOND_S = 1e-9


def steady_clock() -> Clock:
    """Return a clock that no simulation stops or sets."""
    return Clock(clock_type=ClockType.STEADY_TIME)


def seconds(clock: Clock) -> float:
    """Return the time of a clock (s)."""
    return clock.now().nanoseconds * NANOSECOND_S
