"""The one place where code of controllers and hardware, written by anybody, is allowed to fail."""

import logging
from collections.abc import Callable

from arm_control.errors import ArmControlError, UnhandledFailureError

logger = logging.getLogger(__name__)

FailureHandler = Callable[[str, BaseException], None]
"""Gets what outside code raised in a cycle, with a sentence that says where."""


def log_failure(what: str, error: BaseException) -> None:
    """Log it with its traceback; whoever raised it is stopped, the rest goes on."""
    logger.error("%s", what, exc_info=error)


def raise_failure(what: str, error: BaseException) -> None:
    """Let it end the control loop, and the process with it.

    Raises:
        UnhandledFailureError: always.
    """
    raise UnhandledFailureError(
        f"{what}: {type(error).__name__}: {error}; "
        "the process ends, because parameter 'handle_exceptions' is false"
    ) from error


def failure_of(step: Callable[[], object], what: str) -> str:
    """Run a life-cycle step of outside code; return why it failed, empty if it did not.

    A step fails by returning False, by raising an `ArmControlError` with its reason, or by raising
    anything else: then the traceback is logged. SystemExit of a vendor's library is no exception to
    that; Ctrl-C is, where this is the main thread.

    Args:
        step: the call.
        what: names it in the log: "on_activate of controller 'x'".
    """
    try:
        return f"{what} returned False" if step() is False else ""
    except ArmControlError as error:
        return str(error)
    except KeyboardInterrupt:
        raise
    except BaseException as error:
        logger.exception("%s failed", what)
        return f"{what} raised {type(error).__name__}: {error}"
