"""Calls services of one node and waits for the answers."""

import logging
import math
import threading
import time
from collections.abc import Callable, Mapping
from typing import Any

from rclpy.client import Client
from rclpy.exceptions import NameValidationException
from rclpy.node import Node

from arm_control.clock import MonotonicClock
from arm_control.errors import ManagerUnreachableError, WaitInterruptedError
from arm_control.throttle import Throttle
from arm_node.process import first_line

POLL_S = 0.02
PATIENCE_S = 1.0
REPORT_INTERVAL_S = 10.0
ATTEMPTS = 3
QUERY_AGAIN_S = 2.0


class ServiceCaller:
    """Calls the services of a controller manager, ours or a real one's.

    The node must be served by a spinning executor; call the methods from another thread. Each
    raises `ManagerUnreachableError`, or `WaitInterruptedError` where it is told to give up.

    A call that is not answered in time may have been served all the same, so before it is sent
    again the state of things is asked for: nothing is done twice.
    """

    def __init__(
        self,
        node: Node,
        server: str,
        services: Mapping[str, Any],
        timeout_s: float,
        interrupted: Callable[[], bool] = lambda: False,
    ) -> None:
        """Prepare the clients.

        Args:
            node: to make them on.
            server: absolute name of the node that offers the services.
            services: their types by name below the server's.
            timeout_s: how long to wait for an answer before asking again.
            interrupted: says whether to give up waiting.

        Raises:
            ManagerUnreachableError: no node can have that name.
        """
        self._log = logging.getLogger(node.get_logger().name)
        self._server = server
        self._interrupted = interrupted
        self._timeout_s = timeout_s
        # All at once and early: an answer is lost while the server does not know its client yet.
        try:
            self._clients: dict[str, Client] = {
                service: node.create_client(type_, f"{server}/{service}")
                for service, type_ in services.items()
            }
        except NameValidationException as error:
            raise ManagerUnreachableError(
                f"no controller manager can be named '{server}': {first_line(error).rstrip(':')}"
            ) from error

    def wait_for(self, service: str, timeout_s: float) -> None:
        """Wait until a service is offered; 0 for ever."""
        self._wait_for_client(self._clients[service], timeout_s)

    def change(self, service: str, request: Any, is_done: Callable[[], bool]) -> bool:
        """Ask for a change; return whether it was made.

        Args:
            service: its answer has the field `ok`.
            request: what to ask for.
            is_done: asks whether the change was made, where no answer came.
        """
        for _ in range(ATTEMPTS):
            answer = self._try_call(service, request, self._timeout_s)
            if answer is not None:
                message = getattr(answer, "message", "")
                if not answer.ok and message:
                    self._log.error("%s", message)
                return answer.ok
            if is_done():
                return True
        raise self._no_answer(service)

    def query(self, service: str, request: Any) -> Any:
        """Ask something that may be asked twice, so sooner again; return the answer."""
        again_s = min(self._timeout_s, QUERY_AGAIN_S)
        for _ in range(math.ceil(ATTEMPTS * self._timeout_s / again_s)):
            answer = self._try_call(service, request, again_s)
            if answer is not None:
                return answer
        raise self._no_answer(service)

    def _try_call(self, service: str, request: Any, timeout_s: float) -> Any:
        """Ask once; return the answer, None where it did not come in time."""
        client = self._clients[service]
        self._wait_for_client(client, self._timeout_s)
        answered = threading.Event()
        future = client.call_async(request)
        future.add_done_callback(lambda _: answered.set())
        clock = MonotonicClock()
        deadline_s = clock.now_s() + timeout_s
        while not answered.wait(POLL_S):
            self._check_interrupted()
            if clock.now_s() >= deadline_s:
                client.remove_pending_request(future)
                self._log.warning("no answer from %s within %g s", client.srv_name, timeout_s)
                return None
        return future.result()

    def _wait_for_client(self, client: Client, timeout_s: float) -> None:
        # Not Client.wait_for_service: it looks four times a second only, and cannot be ended.
        clock = MonotonicClock()
        start_s = clock.now_s()
        throttle = Throttle(REPORT_INTERVAL_S, clock)
        while not client.service_is_ready():
            waited_s = clock.now_s() - start_s
            if timeout_s and waited_s >= timeout_s:
                raise ManagerUnreachableError(
                    f"Could not contact service {client.srv_name} within {timeout_s:g} s; is a "
                    f"controller manager named {self._server} running, in this ROS domain?"
                )
            if waited_s >= PATIENCE_S and throttle.permits():
                self._log.info("waiting for service %s to become available...", client.srv_name)
            self._check_interrupted()
            time.sleep(POLL_S)

    def _check_interrupted(self) -> None:
        if self._interrupted():
            raise WaitInterruptedError("interrupted")

    def _no_answer(self, service: str) -> ManagerUnreachableError:
        return ManagerUnreachableError(
            f"{self._server}/{service} did not answer {ATTEMPTS} times within "
            f"{self._timeout_s:g} s each"
        )
