"""Limits a speed, its acceleration and its jerk."""

from dataclasses import dataclass, fields, replace
from math import inf, isnan, nan

from arm_control.errors import ParameterError
from arm_control.parameters import parameter


@dataclass(frozen=True, slots=True)
class SpeedLimits:
    """Limits of a velocity along or about an axis and of its derivatives; NaN for no limit."""

    max_velocity: float = parameter(nan, "Upper bound")
    min_velocity: float = parameter(nan, "Lower bound; default -max_velocity")
    max_acceleration: float = parameter(nan, "Upper bound of the acceleration forwards")
    max_deceleration: float = parameter(
        nan, "Lower bound of the deceleration forwards; default max_acceleration_reverse"
    )
    max_acceleration_reverse: float = parameter(
        nan, "Lower bound of the acceleration backwards; default -max_acceleration"
    )
    max_deceleration_reverse: float = parameter(
        nan, "Upper bound of the deceleration backwards; default max_acceleration"
    )
    max_jerk: float = parameter(nan, "Upper bound of the jerk")
    min_jerk: float = parameter(nan, "Lower bound of the jerk; default -max_jerk")
    min_acceleration: float = parameter(nan, "Deprecated and without effect: use max_deceleration")
    has_velocity_limits: bool = parameter(
        True, "Deprecated: false removes the velocity bounds, like .nan in each"
    )
    has_acceleration_limits: bool = parameter(
        True, "Deprecated: false removes the acceleration bounds, like .nan in each"
    )
    has_jerk_limits: bool = parameter(
        True, "Deprecated: false removes the jerk bounds, like .nan in each"
    )

    def in_force(self) -> "SpeedLimits":
        """Return the limits without those that a deprecated parameter removes."""
        removed = [
            bound
            for switch, bounds in _SWITCHES.items()
            if not getattr(self, switch)
            for bound in bounds
        ]
        return replace(self, **dict.fromkeys(removed, nan))

    def deprecations(self, prefix: str) -> list[str]:
        """Return a sentence for each deprecated parameter that is used.

        Args:
            prefix: of the parameters' names, 'linear.x.'.
        """
        sentences = [
            f"parameter '{prefix}{switch}' is deprecated: remove it, and set .nan in "
            f"{', '.join(bounds)} where there is no bound"
            for switch, bounds in _SWITCHES.items()
            if not getattr(self, switch)
        ]
        if not isnan(self.min_acceleration):
            sentences.append(
                f"parameter '{prefix}min_acceleration' is deprecated and has no effect: set "
                f"'{prefix}max_deceleration'"
            )
        return sentences

    def check(self, prefix: str) -> None:
        """Raise `ParameterError` for a bound that has the wrong sign or forbids every motion.

        Args:
            prefix: of the parameters' names, 'linear.x.'.
        """
        for field in fields(self):
            if field.name not in _BOUNDS:
                continue
            value = getattr(self, field.name)
            is_lower = field.name in _LOWER_BOUNDS
            if value > 0 if is_lower else value < 0:
                side = (
                    "a lower bound: it is at most 0"
                    if is_lower
                    else "an upper bound: it is at least 0"
                )
                raise ParameterError(
                    f"parameter '{prefix}{field.name}' is {value:g}, but is {side}"
                )
            if value == 0 and field.name in _NEVER_ZERO:
                raise ParameterError(
                    f"parameter '{prefix}{field.name}' is 0, so the robot could never change its "
                    "speed; .nan stands for no bound"
                )


_SWITCHES = {
    "has_velocity_limits": ("max_velocity", "min_velocity"),
    "has_acceleration_limits": (
        "max_acceleration",
        "max_deceleration",
        "max_acceleration_reverse",
        "max_deceleration_reverse",
    ),
    "has_jerk_limits": ("max_jerk", "min_jerk"),
}
"""The bounds that each deprecated parameter removes."""

_BOUNDS = tuple(bound for bounds in _SWITCHES.values() for bound in bounds)
_LOWER_BOUNDS = ("min_velocity", "max_deceleration", "max_acceleration_reverse", "min_jerk")
_NEVER_ZERO = ("max_acceleration", "max_deceleration", "max_jerk", "min_jerk")


class SpeedLimiter:
    """Follows a target speed as closely as its limits allow. One thread.

    Attributes:
        speed: the last limited speed.
    """

    def __init__(self, limits: SpeedLimits, speed: float = 0.0) -> None:
        """Start at a steady speed."""
        limits = limits.in_force()
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

    def save_state(self) -> tuple[float, float]:
        """Return the speed and its last change."""
        return self.speed, self._change

    def load_state(self, state: tuple[float, float]) -> None:
        """Set the speed and its last change."""
        self.speed, self._change = state

    def limit(self, wanted: float, period_s: float) -> float:
        """Return the speed for a cycle.

        Args:
            wanted: target speed.
            period_s: time since the last cycle; above 0.
        """
        change = wanted - self.speed
        # The jerk of a braking robot is not limited: that would make the speed oscillate about the
        # target.
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
