"""Services that answer whatever happens: a client without an answer waits for ever."""

import logging
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext
from typing import Any

from rclpy.callback_groups import CallbackGroup
from rclpy.node import Node

from arm_node.qos import SERVICE_QOS
from arm_planning.errors import InvalidRequestError, MoveItErrorCode, PlanningError
from arm_planning.ros.convert import error_code

HOLDERS = ("motion_plan_response", "response")
"""Fields of answers and results that have the error code, where they have none themselves."""
LOGGER = logging.getLogger("move_group")

Serve = Callable[[Any, Any], Any]
"""Takes a request and an empty response; returns the response."""


class BusyLimit:
    """Lets so many requests plan at a time, so that threads are left to cancel and to look."""

    def __init__(self, most: int) -> None:
        self.most = most
        self._free = threading.BoundedSemaphore(most)

    @contextmanager
    def turn(self, name: str) -> Iterator[None]:
        """Serve a request, or refuse it with a PlanningError while too many others are served."""
        if not self._free.acquire(blocking=False):
            raise InvalidRequestError(
                f"{name}: {self.most} other requests are being served; ask again later"
            )
        try:
            yield
        finally:
            self._free.release()


def offer_service(
    node: Node,
    kind: type[Any],
    name: str,
    serve: Serve,
    *,
    group: CallbackGroup | None = None,
    limit: BusyLimit | None = None,
) -> None:
    """Offer a service; all of this package are made here, so that each of them answers.

    An exception of `serve`, which fills the response, is logged and answered: a PlanningError with
    its code, any other with FAILURE. By default no other callback of the node's own group may run
    beside it. A limit is shared by the services that take long.
    """

    def answer(request: Any, response: Any) -> Any:
        try:
            with nullcontext() if limit is None else limit.turn(name):
                return serve(request, response)
        except PlanningError as error:
            LOGGER.error("%s: %s", name, error)
            code, sentence = error.code, str(error)
        except Exception as error:
            code, sentence = MoveItErrorCode.FAILURE, report_fault(name, error)
        failed = type(response)()
        fill_error(failed, code, sentence)
        return failed

    node.create_service(kind, name, answer, qos_profile=SERVICE_QOS, callback_group=group)


def report_fault(name: str, error: Exception) -> str:
    """Log the traceback of the exception being handled; return a sentence for the client."""
    LOGGER.exception("%s has a fault", name)
    return f"{name} has a fault, please report it: {type(error).__name__}: {error}"


def fill_error(message: Any, code: MoveItErrorCode, sentence: str) -> None:
    """Fill the error code of an answer or result; one that has none stays as it is."""
    inner = next((getattr(message, name) for name in HOLDERS if hasattr(message, name)), message)
    if hasattr(inner, "error_code"):
        inner.error_code = error_code(code, sentence)
