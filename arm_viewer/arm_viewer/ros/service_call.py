"""One call of a service, from finding the server to the answer."""

import time
from collections.abc import Callable
from typing import Any

from rclpy.node import Node

from arm_node.messages.filling import FilledMessage
from arm_node.testing import DiscoveryCheck
from arm_viewer.calls.call import CallState, failure, shown
from arm_viewer.ros.service_caller import ServiceCaller

ANSWER_S = 30.0
"""After this time a service counts as silent."""
FIND_S = 5.0
"""How long a server may take to be found."""
KNOWN_S = 3.0
"""How long a server may take to find this node; an answer that it sends earlier is lost."""

Report = Callable[[CallState], None]


class KnownService:
    """A client whose server knows it before it is asked. Use it in the executor's thread."""

    def __init__(self, node: Node, service_class: Any, name: str) -> None:
        """Look for the server."""
        self._caller = ServiceCaller(node, service_class, name, ANSWER_S)
        self._check: DiscoveryCheck | None = DiscoveryCheck.with_server(node, name)
        self._start_s = time.monotonic()
        self._is_asked = False
        self.name = name

    def ask(self, now_s: float, request: Any, then: Callable[[Any], None]) -> str:
        """Ask once as soon as it is possible; call it until `then` was called.

        Returns:
            Why there will be no answer; "" as long as there may be one.
        """
        if self._is_asked:
            if not self._caller.is_ready():
                return f"the server of {self.name} has ended before it answered"
            if self._caller.is_overdue():
                return f"{self.name} has not answered within {ANSWER_S:g} s"
        elif self._is_found(now_s):
            self._is_asked = self._caller.ask(request, then)
        elif now_s - self._start_s > FIND_S and not self._caller.is_ready():
            return f"no server offers {self.name}"
        return ""

    def close(self) -> None:
        """Destroy the client."""
        self._end_check()
        self._caller.close()

    def _is_found(self, now_s: float) -> bool:
        if self._check is None:
            return True
        if not self._caller.is_ready():
            return False
        if not self._check.complete and now_s - self._start_s < KNOWN_S:
            return False
        self._end_check()
        return True

    def _end_check(self) -> None:
        if self._check is not None:
            self._check.close()
            self._check = None


class ServiceCall:
    """Calls a service once, and reports the answer."""

    def __init__(
        self, node: Node, service_class: Any, name: str, filled: FilledMessage, report: Report
    ) -> None:
        """Look for the server; `check` does the rest."""
        self._node = node
        self._filled = filled
        self._report = report
        self._service = KnownService(node, service_class, name)
        self._start_s = time.monotonic()
        report(CallState("Waiting for the answer"))

    def check(self, now_s: float) -> None:
        """Send the request when that is possible; report that no answer comes."""
        self._filled.stamp(self._node.get_clock().now().to_msg())
        problem = self._service.ask(now_s, self._filled.message, self._answer)
        if problem:
            self._report(failure(problem))

    def cancel(self) -> None:
        """Stop waiting."""
        self._report(failure("Not waited for any longer; the server may still carry it out"))

    def close(self) -> None:
        """Destroy the client."""
        self._service.close()

    def _answer(self, response: Any) -> None:
        took_s = time.monotonic() - self._start_s
        is_refused = getattr(response, "success", True) is False
        text = "The service says that it failed" if is_refused else f"Answered after {took_s:.2f} s"
        self._report(CallState(text, shown(response), is_over=True, is_failed=is_refused))
