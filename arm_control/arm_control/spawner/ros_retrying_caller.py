"""Calls a controller manager from a thread that may wait, and retries without an answer."""

import logging
import math
import threading
import time
from collections.abc import Callable, Iterable
from typing import Any

from rclpy.client import Client
from rclpy.exceptions import NameValidationException
from rclpy.node import Node

from arm_control.errors import ManagerUnreachableError, WaitInterruptedError
from arm_control.loop.clock import MonotonicClock, Throttle
from arm_node.controller_manager import SERVICES
from arm_node.printable import first_line

POLL_S = 0.02
PATIENCE_S = 1.0
REPORT_INTERVAL_S = 10.0
ATTEMPTS = 3
QUERY_AGAIN_S = 2.0


class RetryingCaller:
    """Calls the services of a controller manager; implements `ServiceTransport`.

    A spinning executor must serve the node; call the methods from another thread. Each raises
    `ManagerUnreachableError`, or `WaitInterruptedError` if the process must end.

    A call without a timely answer may have been served all the same. Before it is sent again, the
    caller checks the current state, so that nothing is done twice.
    """

    def __init__(
        self,
        node: Node,
        server: str,
        services: Iterable[str],
        timeout_s: float,
        interrupted: Callable[[], bool] = lambda: False,
    ) -> None:
        """Prepare the clients.

        Args:
            node: node of the clients.
            server: absolute name of the node that offers the services.
            services: names of the services to call.
            timeout_s: how long to wait for an answer before asking again.
            interrupted: returns whether to stop waiting.

        Raises:
            ManagerUnreachableError: the name is not a valid node name.
        """
        self._log = logging.getLogger(node.get_logger().name)
        self._server = server
        self._interrupted = interrupted
        self._timeout_s = timeout_s
        # All at once and early: until the server has discovered a client, its answers are lost.
        try:
            self._clients: dict[str, Client] = {
                service: node.create_client(SERVICES[service], f"{server}/{service}")
                for service in services
            }
        except NameValidationException as error:
            raise ManagerUnreachableError(
                f"no controller manager can be named '{server}': {first_line(error).rstrip(':')}"
            ) from error

    def wait_for(self, service: str, timeout_s: float) -> None:
        """Wait until a service is available; a timeout of 0 waits for ever."""
        self._wait_for_client(self._clients[service], timeout_s)

    def change(self, service: str, request: Any, is_done: Callable[[], bool]) -> Any:
        """Request a change; return the answer, and log why it was refused.

        Args:
            service: a service whose answer has the field `ok`.
            request: the request.
            is_done: checks whether the change was made although no answer came.
        """
        for _ in range(ATTEMPTS):
            answer = self._try_call(service, request, self._timeout_s)
            if answer is not None:
                message = getattr(answer, "message", "")
                if not answer.ok and message:
                    self._log.error("%s", message)
                return answer
            if is_done():
                return SERVICES[service].Response(ok=True)
        raise self._no_answer(service)

    def query(self, service: str, request: Any) -> Any:
        """Call a service that changes nothing, with quicker retries; return the answer."""
        again_s = min(self._timeout_s, QUERY_AGAIN_S)
        for _ in range(math.ceil(ATTEMPTS * self._timeout_s / again_s)):
            answer = self._try_call(service, request, again_s)
            if answer is not None:
                return answer
        raise self._no_answer(service)

    def _try_call(self, service: str, request: Any, timeout_s: float) -> Any:
        """Call once; return the answer, None if it did not come in time."""
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
        # Not Client.wait_for_service, which checks only four times a second and cannot be
        # interrupted.
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
