"""Services that answer whatever happens: a client without an answer waits for ever.

Those that answer at once get a thread of their own, whose executor serves nothing else. For a
request, rclpy's executors build several times anew what they wait for, all services, actions and
topics of a node. That takes longer than such an answer.
"""

import logging
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext
from typing import Any

from rclpy.callback_groups import CallbackGroup, ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor, SingleThreadedExecutor
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


class QuickServices(ReentrantCallbackGroup):
    """The group of the services of a node that answer at once."""


class QuickExecutor(SingleThreadedExecutor):
    """Serves such a group, whose services are all made before, one request at a time.

    The node belongs to another executor.
    """

    def __init__(self, node: Node, group: QuickServices) -> None:
        super().__init__(context=node.context)
        self._node, self._group = node, group

    def get_nodes(self) -> list[Node]:
        """Return the node."""
        return [self._node]

    def can_execute(self, entity: Any) -> bool:
        """Return whether it is of the group, and is not being served."""
        return entity.callback_group is self._group and super().can_execute(entity)


class SlowExecutor(MultiThreadedExecutor):
    """Serves nodes on several threads, but for their quick services."""

    def can_execute(self, entity: Any) -> bool:
        """Return whether it is not of such a group, and may be served now."""
        is_quick = isinstance(entity.callback_group, QuickServices)
        return not is_quick and super().can_execute(entity)
