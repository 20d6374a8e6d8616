"""Runs and measures the code of controllers and drivers, which may fail in any way."""

import logging
from collections.abc import Callable
from dataclasses import dataclass

from arm_control.errors import ArmControlError, UnhandledFailureError
from arm_control.loop.clock import MonotonicClock
from arm_control.loop.run_record import RunRecord

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
    KeyboardInterrupt passes through.

    Args:
        step: the call.
        what: describes it in the log: "on_activate of controller 'x'".
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


@dataclass(frozen=True, slots=True)
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
