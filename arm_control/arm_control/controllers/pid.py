"""PID control of several joints at once, as control_toolbox computes it."""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class AntiWindup(Enum):
    """Anti-windup strategy; the value is the one of the parameter.

    LEGACY clamps the integral's contribution but not the integral itself, unless
    `clamps_integral` is set. CONDITIONAL_INTEGRATION stops integrating while the output is
    saturated and the error would drive it further. BACK_CALCULATION feeds the saturation back into
    the integral. NONE does nothing.
    """

    LEGACY = "legacy"
    NONE = "none"
    BACK_CALCULATION = "back_calculation"
    CONDITIONAL_INTEGRATION = "conditional_integration"


@dataclass(frozen=True, slots=True)
class PidGains:
    """Gains of one joint.

    Attributes:
        p: gain of the position error.
        i: gain of its integral.
        d: gain of the velocity error.
        i_max: upper bound of the integral's contribution.
        i_min: lower bound of the integral's contribution.
        u_max: upper bound of the output.
        u_min: lower bound of the output.
        anti_windup: the anti-windup strategy.
        clamps_integral: whether LEGACY clamps the integral itself as well.
        tracking_time_constant: time constant of BACK_CALCULATION [s]; 0 derives it from the gains.
        error_deadband: errors up to this are not integrated.
    """

    p: float = 0.0
    i: float = 0.0
    d: float = 0.0
    i_max: float = np.inf
    i_min: float = -np.inf
    u_max: float = np.inf
    u_min: float = -np.inf
    anti_windup: AntiWindup = AntiWindup.LEGACY
    clamps_integral: bool = False
    tracking_time_constant: float = 0.0
    error_deadband: float = 0.0


class Pid:
    """One controller for each of n joints. One thread at a time."""

    def __init__(self, gains: Sequence[PidGains]) -> None:
        """Start with these gains and no integral."""
        self._integral = np.zeros(len(gains))
        self.set_gains(gains)

    @property
    def integral(self) -> NDArray[np.float64]:
        """The integral's contribution before clamping, shape (n,); a copy."""
        return self._integral.copy()

    def reset(self, kept: NDArray[np.bool_]) -> None:
        """Reset the integrals of the joints that are not `kept`, shape (n,)."""
        self._integral[~kept] = 0.0

    def save_state(self) -> Array:
        """Return the integrals, shape (n,)."""
        return self._integral

    def load_state(self, state: Array) -> None:
        """Set the integrals."""
        self._integral = state

    def set_gains(self, gains: Sequence[PidGains]) -> None:
        """Replace the gains, one for each joint; the integrals stay."""
        self._p, self._i, self._d = (_column(gains, name) for name in ("p", "i", "d"))
        self._u_max, self._u_min = _column(gains, "u_max"), _column(gains, "u_min")
        self._deadband = _column(gains, "error_deadband")
        legacy = _uses(gains, AntiWindup.LEGACY)
        self._i_max = np.where(legacy, _column(gains, "i_max"), np.inf)
        self._i_min = np.where(legacy, _column(gains, "i_min"), -np.inf)
        clamped = np.array([gain.clamps_integral for gain in gains], dtype=np.bool_)
        self._integral_max = np.where(clamped, self._i_max, np.inf)
        self._integral_min = np.where(clamped, self._i_min, -np.inf)
        self._conditional = _uses(gains, AntiWindup.CONDITIONAL_INTEGRATION)
        self._back = np.array([_back_gain(gain) for gain in gains])
        self._grows_first = legacy
        self._all_grow_first = bool(legacy.all())
        self._integrates = bool(self._i.any())

    def update(self, error: Array, rate: Array, period_s: float) -> NDArray[np.float64]:
        """Return the outputs for errors of position and of velocity, shape (n,)."""
        output = self._p * error + self._d * rate
        if not self._integrates:
            return self._saturated(output)
        # A NaN error is not integrated: a faulty sensor must not corrupt the integral permanently.
        counts = np.abs(error) > self._deadband
        growth = np.where(counts, self._i * period_s * error, 0.0)
        self._integral += growth * self._grows_first
        self._integral = np.minimum(
            np.maximum(self._integral, self._integral_min), self._integral_max
        )
        wanted = output + np.minimum(np.maximum(self._integral, self._i_min), self._i_max)
        output = self._saturated(wanted)
        if not self._all_grow_first:
            held = self._conditional & (wanted != output) & (error * wanted > 0.0)
            pull = self._back * period_s * np.where(counts, output - wanted, 0.0)
            self._integral += np.where(self._grows_first | held, 0.0, growth + pull)
        return output

    def _saturated(self, output: Array) -> NDArray[np.float64]:
        return np.minimum(np.maximum(output, self._u_min), self._u_max)


def _column(gains: Sequence[PidGains], name: str) -> NDArray[np.float64]:
    return np.array([getattr(gain, name) for gain in gains])


def _uses(gains: Sequence[PidGains], strategy: AntiWindup) -> NDArray[np.bool_]:
    return np.array([gain.anti_windup is strategy for gain in gains])


def _back_gain(gains: PidGains) -> float:
    """Return the gain of back calculation [1/s].

    The default time constant is sqrt(d / i), or p / i without d (Åström & Hägglund, PID
    Controllers, 1995).
    """
    if gains.anti_windup is not AntiWindup.BACK_CALCULATION or not gains.i:
        return 0.0
    time_constant = gains.tracking_time_constant
    if not time_constant:
        time_constant = np.sqrt(gains.d / gains.i) if gains.d else gains.p / gains.i
    return 1.0 / time_constant if time_constant > 0.0 else 0.0
