"""A timed trajectory of a group."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class TimedTrajectory:
    """Way points of a group's joints over time, as a controller gets them.

    Attributes:
        joints: names of the joints, n of them.
        times_s: time of each point from the start, (m,), increasing from 0.
        positions: rad or m, (m, n).
        velocities: per s, (m, n).
        accelerations: per s^2, (m, n).
    """

    joints: tuple[str, ...]
    times_s: Array
    positions: Array
    velocities: Array
    accelerations: Array

    @property
    def duration_s(self) -> float:
        """Time of the last point; 0 for an empty trajectory."""
        return float(self.times_s[-1]) if len(self.times_s) else 0.0
