"""Derive the physics step from the control rate."""

import math

from arm_gazebo.errors import TimingError
from arm_node.frozen import frozen

MAX_STEP_S = 0.002
MIN_STEP_S = 1e-6
"""A shorter step is a typing error: the simulation would never get anywhere."""
DIVIDES_WITHIN = 1e-6
"""Largest relative error at which a step counts as a divisor, because decimal steps are rounded."""


@frozen
class PhysicsTiming:
    """One control period and the physics steps that fill it.

    Attributes:
        period_s: control period.
        steps: physics steps in one control period.
    """

    period_s: float
    steps: int

    @property
    def step_s(self) -> float:
        """Length of one physics step."""
        return self.period_s / self.steps


def physics_timing(update_rate_hz: float, fixed_step_s: float | None = None) -> PhysicsTiming:
    """Return the largest physics step up to `MAX_STEP_S` that divides the control period.

    A step that the user fixed, `fixed_step_s`, must divide the period.

    Raises:
        TimingError: the rate is not above 0, the fixed step does not divide the period, or a step
            is shorter than `MIN_STEP_S`.
    """
    if not (math.isfinite(update_rate_hz) and update_rate_hz > 0):
        raise TimingError(f"update_rate must be above 0 Hz, not {update_rate_hz:g}")
    if fixed_step_s is not None and not (math.isfinite(fixed_step_s) and fixed_step_s > 0):
        raise TimingError(f"the physics step must be above 0 s, not {fixed_step_s:g}")
    period_s = 1.0 / update_rate_hz
    if min(period_s, fixed_step_s or period_s) < MIN_STEP_S:
        what = "update_rate" if fixed_step_s is None else "the physics step"
        raise TimingError(
            f"{what} makes physics steps shorter than {MIN_STEP_S:g} s; update_rate is "
            f"{update_rate_hz:g} Hz"
        )
    if fixed_step_s is None:
        # The margin keeps 500 Hz at one step of 2 ms despite rounding.
        return PhysicsTiming(period_s, math.ceil(period_s / MAX_STEP_S * (1 - DIVIDES_WITHIN)))
    steps = max(1, round(period_s / fixed_step_s))
    if abs(steps * fixed_step_s - period_s) > DIVIDES_WITHIN * period_s:
        raise TimingError(
            f"a physics step of {fixed_step_s:g} s does not divide the control period of "
            f"{period_s:.6g} s (update_rate {update_rate_hz:g} Hz); "
            f"{period_s / steps:.6g} s would"
        )
    return PhysicsTiming(period_s, steps)
