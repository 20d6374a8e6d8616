"""Runs and measures the code of controllers and drivers, which may fail in any way."""

import logging
from collections import deque
from collections.abc import Callable
from math import nan

import numpy as np
from numpy.typing import NDArray

from arm_control.errors import ArmControlError, UnhandledFailureError
from arm_control.loop.clock import MonotonicClock
from arm_node.frozen import frozen

_MICROSECONDS = 1e6


@frozen
class Spread:
    """Statistics of a set of samples, in the unit of the samples."""

    mean: float
    standard_deviation: float
    minimum: float
    maximum: float


@frozen
class RunStatistics:
    """Statistics of the latest runs.

    Attributes:
        periodicity_hz: rate of the runs; None without two runs in a row.
        execution_time_us: duration of the runs.
    """

    periodicity_hz: Spread | None
    execution_time_us: Spread


class RunRecord:
    """The latest runs of a controller, a component or the whole loop.

    One thread adds runs; that takes a twentieth of a microsecond, in bounded memory. Any other
    thread may read the statistics at any time.

    Two C functions add a run, because each call of a Python function in every tick counts. A pair
    of numbers would be an object that Python's garbage collector visits.

    Attributes:
        add_period: adds the time in s since the start of the previous run; not positive or NaN if
            unknown.
        add_duration: adds the wall time in s that the run took.
    """

    __slots__ = ("_durations_s", "_periods_s", "add_duration", "add_period")

    def __init__(self, size: int) -> None:
        """Make a record of this many runs."""
        self._periods_s: deque[float] = deque(maxlen=size)
        self._durations_s: deque[float] = deque(maxlen=size)
        self.add_period: Callable[[float], None] = self._periods_s.append
        self.add_duration: Callable[[float], None] = self._durations_s.append

    def clear(self) -> None:
        """Forget all runs. Only the thread that adds them."""
        self._periods_s.clear()
        self._durations_s.clear()

    @property
    def latest_us(self) -> float:
        """Microseconds that the latest run took, NaN if there is none; any thread."""
        durations_s = self._durations_s.copy()
        return durations_s[-1] * _MICROSECONDS if durations_s else nan

    @property
    def latest_hz(self) -> float:
        """One over the latest period, NaN if that is unknown; any thread."""
        periods_s = self._periods_s.copy()
        return 1.0 / periods_s[-1] if periods_s and periods_s[-1] > 0.0 else nan

    def statistics(self) -> RunStatistics | None:
        """Return the statistics of the runs so far, None if there are none; any thread."""
        # Copying a deque is atomic in CPython, so the other thread cannot change it half-way.
        durations_s = np.array(self._durations_s.copy())
        periods_s = np.array(self._periods_s.copy())
        if not durations_s.size:
            return None
        return RunStatistics(_rate(periods_s), _spread(durations_s * _MICROSECONDS))


def _spread(samples: NDArray[np.float64]) -> Spread:
    return Spread(
        float(samples.mean()), float(samples.std()), float(samples.min()), float(samples.max())
    )


def _rate(periods_s: NDArray[np.float64]) -> Spread | None:
    """Return rates in Hz; the mean is one over the mean period, not the mean of the rates.

    With the mean of the rates, two runs in quick succession after a late one would outweigh all
    others. The standard deviation is propagated from the periods' to first order.
    """
    # NaN before the first run; not positive if the clock stood still.
    periods_s = periods_s[periods_s > 0.0]
    if not periods_s.size:
        return None
    mean_hz = 1.0 / float(periods_s.mean())
    return Spread(
        mean_hz,
        float(periods_s.std()) * mean_hz**2,
        1.0 / float(periods_s.max()),
        1.0 / float(periods_s.min()),
    )


logger = logging.getLogger("controller_manager")

FailureHandler = Callable[[str, BaseException], None]
"""Receives an exception that user code raised in a cycle, and a sentence that says where."""


def log_failure(what: str, error: BaseException) -> None:
    """Log the error with its traceback; the manager stops that component and goes on."""
    logger.error("%s", what, exc_info=error)


def raise_failure(what: str, error: BaseException) -> None:
    """End the control loop, and the process with it.

    Raises:
        UnhandledFailureError: always.
    """
    raise UnhandledFailureError(
        f"{what}: {type(error).__name__}: {error}; "
        "the process ends, because parameter 'handle_exceptions' is false"
    ) from error


def failure_of(step: Callable[[], object], what: str) -> str:
    """Run a life-cycle step of user code; return why it failed, or an empty string.

    A step fails if it returns False or raises. For an `ArmControlError` its message is the reason;
    any other exception is logged with its traceback, even SystemExit from a vendor's library. Only
    KeyboardInterrupt passes through. The log calls it `what`: "on_activate of controller 'x'".
    """
    try:
        return f"{what} returned False" if step() is False else ""
    except ArmControlError as error:
        return str(error)
    except KeyboardInterrupt:
        raise
    except BaseException as error:  # User code may raise even SystemExit.
        logger.exception("%s failed", what)
        return f"{what} raised {type(error).__name__}: {error}"


@frozen
class RunSupervision:
    """How runs of controllers and components are measured, and how exceptions are handled.

    Attributes:
        samples: how many of the latest runs the statistics cover.
        now_s: wall time for execution times.
        on_exception: receives an exception of a run; returns if the manager should go on.
    """

    samples: int = 500
    now_s: Callable[[], float] = MonotonicClock.now_s
    on_exception: FailureHandler = log_failure

    def record(self) -> RunRecord:
        """Make a record for something that runs."""
        return RunRecord(self.samples)
