"""What the driver of an arm needs from the device behind its port."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class ArmReading:
    """What the joints reported in one exchange.

    Attributes:
        positions: shape (n,), in rad; NaN for a joint that did not report.
        velocities: shape (n,), in rad/s; NaN where unknown.
        efforts: shape (n,), in N m; NaN where unknown.
        alarms: one sentence for each joint that reports an alarm of its own.
    """

    positions: NDArray[np.float64]
    velocities: NDArray[np.float64]
    efforts: NDArray[np.float64]
    alarms: tuple[str, ...] = ()


class ArmDevice(Protocol):
    """An arm on an open port. One thread at a time.

    Each method may raise a DriverError, whose message is for the user.

    Attributes:
        names: a name for each joint, for messages.
        lower: shape (n,), lowest position that the arm itself accepts, in rad.
        upper: shape (n,), highest.
        max_speed: rad/s that no joint exceeds, also when it is moved by hand.
    """

    names: Sequence[str]
    lower: NDArray[np.float64]
    upper: NDArray[np.float64]
    max_speed: float

    def start(self) -> None:
        """Check that the arm is the expected one and is fit to run; it does not move."""
        ...

    def engage(self, positions: NDArray[np.float64]) -> None:
        """Hold these positions, shape (n,), in rad, which are the measured ones; power on."""
        ...

    def release(self) -> None:
        """Power off: the joints can be moved by hand, and an arm may fall."""
        ...

    def exchange(self, goals: NDArray[np.float64] | None) -> ArmReading:
        """Send goals within the limits, shape (n,), in rad, or none; return a reading."""
        ...

    def close(self) -> None:
        """Close the port; the arm does what it was told last."""
        ...
