"""What a driven joint does with its commands."""

from enum import Enum


class DriveMode(Enum):
    """How a joint is driven; the values of the last three are ros2_control's interface names."""

    LIMP = "limp"
    """No effort at all: the joint falls."""
    HOLD = "hold"
    """Brake, then stand."""
    POSITION = "position"
    """Go to the commanded position, in rad or m."""
    VELOCITY = "velocity"
    """Move at the commanded velocity, in rad/s or m/s; stop before the joint's limit."""
    EFFORT = "effort"
    """Exert the commanded effort, in N m or N."""


SERVOED = frozenset({DriveMode.HOLD, DriveMode.POSITION, DriveMode.VELOCITY})
"""Modes in which a set-point is followed."""
