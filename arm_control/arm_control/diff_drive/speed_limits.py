"""The bounds of one speed, as parameters."""

from dataclasses import dataclass, fields
from math import nan

from arm_control.errors import ParameterError
from arm_control.parameters import parameter


@dataclass(frozen=True, slots=True)
class SpeedLimits:
    """Of a speed along an axis or about it, and of its derivatives; NaN stands for none given."""

    max_velocity: float = parameter(nan, "Upper bound")
    min_velocity: float = parameter(nan, "Lower bound; without one -max_velocity")
    max_acceleration: float = parameter(nan, "Upper bound of the rate going faster forwards")
    max_deceleration: float = parameter(
        nan, "Lower bound of the rate braking forwards; without one that of going faster backwards"
    )
    max_acceleration_reverse: float = parameter(
        nan, "Lower bound of the rate going faster backwards; without one -max_acceleration"
    )
    max_deceleration_reverse: float = parameter(
        nan, "Upper bound of the rate braking backwards; without one max_acceleration"
    )
    max_jerk: float = parameter(nan, "Upper bound of the rate's rate")
    min_jerk: float = parameter(nan, "Lower bound of the rate's rate; without one -max_jerk")

    def check(self, prefix: str) -> None:
        """Raise `ParameterError` for a bound that has the wrong sign or forbids every motion.

        Args:
            prefix: of the parameters' names, 'linear.x.'.
        """
        for field in fields(self):
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


_LOWER_BOUNDS = ("min_velocity", "max_deceleration", "max_acceleration_reverse", "min_jerk")
_NEVER_ZERO = ("max_acceleration", "max_deceleration", "max_jerk", "min_jerk")
