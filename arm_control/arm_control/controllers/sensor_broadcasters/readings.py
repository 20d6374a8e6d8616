"""The state interfaces of sensors, and what receives their readings."""

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

IMU_INTERFACES = (
    "orientation.x",
    "orientation.y",
    "orientation.z",
    "orientation.w",
    "angular_velocity.x",
    "angular_velocity.y",
    "angular_velocity.z",
    "linear_acceleration.x",
    "linear_acceleration.y",
    "linear_acceleration.z",
)
FORCE_TORQUE_INTERFACES = ("force.x", "force.y", "force.z", "torque.x", "torque.y", "torque.z")


class ReadingSink(Protocol):
    """Receives the readings on the loop thread."""

    def wanted(self) -> bool:
        """Return whether there is a subscriber now."""
        ...

    def publish(self, time_s: float, reading: NDArray[np.float64]) -> None:
        """Publish a reading, shape (n,), which is reused for the next one."""
        ...
