"""Keeps a speed and its changes within bounds."""

from math import inf, isnan

from arm_control.diff_drive.speed_limits import SpeedLimits


class SpeedLimiter:
    """Follows a wanted speed as closely as its limits let it. One thread.

    Attributes:
        speed: what it let through last.
    """

    def __init__(self, limits: SpeedLimits, speed: float = 0.0) -> None:
        """Begin at a steady speed."""
        upper = _or(limits.max_velocity, inf)
        self._velocity = (_or(limits.min_velocity, -upper), upper)
        faster = _or(limits.max_acceleration, inf)
        faster_backwards = _or(limits.max_acceleration_reverse, -faster)
        braking = _or(limits.max_deceleration, faster_backwards)
        braking_backwards = _or(limits.max_deceleration_reverse, faster)
        self._forwards = (braking, faster)
        self._backwards = (faster_backwards, braking_backwards)
        self._from_rest = (faster_backwards, faster)
        jerk = _or(limits.max_jerk, inf)
        self._jerk = (_or(limits.min_jerk, -jerk), jerk)
        self.speed = speed
        self._change = 0.0

    def limit(self, wanted: float, period_s: float) -> float:
        """Return the speed for a cycle.

        Args:
            wanted: speed to go at.
            period_s: since the last cycle; more than 0.
        """
        change = wanted - self.speed
        # Braking ever harder is let be: a bound on it makes the speed swing about the wanted one.
        if (change - self._change) * change > 0:
            low, high = (bound * period_s**2 for bound in self._jerk)
            change = self._change + _clamp(change - self._change, low, high)
        low, high = (bound * period_s for bound in self._rates())
        speed = _clamp(self.speed + _clamp(change, low, high), *self._velocity)
        self._change = speed - self.speed
        self.speed = speed
        return speed

    def _rates(self) -> tuple[float, float]:
        if self.speed > 0:
            return self._forwards
        return self._backwards if self.speed < 0 else self._from_rest


def _or(value: float, default: float) -> float:
    return default if isnan(value) else value


def _clamp(value: float, low: float, high: float) -> float:
    return min(max(value, low), high)
