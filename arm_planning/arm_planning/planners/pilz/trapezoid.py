"""Motion along a path with a trapezoid as its speed: accelerate, cruise, brake."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Trapezoid:
    """From rest to rest, as fast as the limits allow.

    Attributes:
        length: how far it goes, above 0.
        velocity: largest speed, above 0.
        acceleration: above 0.
        deceleration: above 0.
    """

    length: float
    velocity: float
    acceleration: float
    deceleration: float

    @property
    def peak(self) -> float:
        """The largest speed that it reaches."""
        both = 1.0 / self.acceleration + 1.0 / self.deceleration
        return min(self.velocity, math.sqrt(2.0 * self.length / both))

    @property
    def duration_s(self) -> float:
        """How long it takes."""
        ramps = self.peak / self.acceleration + self.peak / self.deceleration
        return self.length / self.peak + 0.5 * ramps

    def distance(self, times_s: Array) -> Array:
        """Return how far it has gone at times from 0 to its duration."""
        up, down = self.peak / self.acceleration, self.peak / self.deceleration
        left = self.duration_s - times_s
        rising = 0.5 * self.acceleration * times_s**2
        falling = self.length - 0.5 * self.deceleration * left**2
        even = self.peak * (times_s - 0.5 * up)
        gone = np.where(times_s < up, rising, np.where(left < down, falling, even))
        return np.clip(gone, 0.0, self.length)
