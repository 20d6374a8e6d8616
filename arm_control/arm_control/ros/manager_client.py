"""A client of a controller manager's services, ours or a real one's."""

import logging
import math
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from builtin_interfaces.msg import Duration
from controller_manager_msgs.srv import (
    ConfigureController,
    ListControllers,
    LoadController,
    SwitchController,
    UnloadController,
)
from rcl_interfaces.srv import SetParameters
from rclpy.client import Client
from rclpy.node import Node
from rclpy.parameter import Parameter

from arm_control.clock import MonotonicClock
from arm_control.errors import ArmControlError
from arm_control.throttle import Throttle

logger = logging.getLogger(__name__)

POLL_S = 0.02
PATIENCE_S = 1.0
REPORT_INTERVAL_S = 10.0
ATTEMPTS = 3
QUERY_AGAIN_S = 2.0

_SERVICES = {
    "configure_controller": ConfigureController,
    "list_controllers": ListControllers,
    "load_controller": LoadController,
    "set_parameters": SetParameters,
    "switch_controller": SwitchController,
    "unload_controller": UnloadController,
}


class ManagerUnreachableError(ArmControlError):
    """The controller manager is not there, or does not answer."""


class InterruptedCallError(ArmControlError):
    """Whoever waits was told to give up."""


class ManagerClient:
    """Calls the manager's services and waits for the answers.

    The node must be served by a spinning executor; call the methods from another thread. Each
    raises `ManagerUnreachableError`, or `InterruptedCallError` where it is told to give up.

    A call that is not answered in time may have been served all the same, so before it is sent
    again the state of things is asked for: nothing is done twice.
    """

    def __init__(
        self,
        node: Node,
        manager: str,
        timeout_s: float,
        interrupted: Callable[[], bool] = lambda: False,
    ) -> None:
        """Prepare the clients.

        Args:
            node: to make them on.
            manager: absolute name of the manager's node.
            timeout_s: how long to wait for an answer before asking again.
            interrupted: says whether to give up waiting.
        """
        self._manager = manager
        self._interrupted = interrupted
        self._timeout_s = timeout_s
        # All at once and early: an answer is lost while the server does not know its client yet.
        self._clients: dict[str, Client] = {
            service: node.create_client(type_, f"{manager}/{service}")
            for service, type_ in _SERVICES.items()
        }

    def wait_for_manager(self, timeout_s: float) -> None:
        """Wait until the manager offers its services; 0 for ever."""
        self._wait_for_service(self._clients["list_controllers"], timeout_s)

    def states(self) -> Mapping[str, str]:
        """Return the state of each loaded controller."""
        answer = self._query("list_controllers", ListControllers.Request())
        return {controller.name: controller.state for controller in answer.controller}

    def set_parameters(self, parameters: Mapping[str, str | Sequence[str]]) -> str:
        """Set parameters of the manager's node; return why it refused one, or nothing."""
        request = SetParameters.Request(
            parameters=[
                Parameter(
                    name, value=value if isinstance(value, str) else list(value)
                ).to_parameter_msg()
                for name, value in parameters.items()
            ]
        )
        answer = self._query("set_parameters", request)
        return "; ".join(result.reason for result in answer.results if not result.successful)

    def load(self, name: str) -> bool:
        """Load a controller; return whether it is."""
        request = LoadController.Request(name=name)
        return self._change("load_controller", request, lambda s: name in s)

    def configure(self, name: str) -> bool:
        """Configure a controller; return whether it is."""
        request = ConfigureController.Request(name=name)
        return self._change(
            "configure_controller", request, lambda states: states.get(name) == "inactive"
        )

    def unload(self, name: str) -> bool:
        """Unload a controller; return whether it is gone."""
        request = UnloadController.Request(name=name)
        return self._change("unload_controller", request, lambda s: name not in s)

    def activate(self, names: Sequence[str], timeout_s: float, *, asap: bool = True) -> bool:
        """Activate all of these in one strict switch; return whether they are."""
        return self._switch(
            SwitchController.Request(activate_controllers=list(names), activate_asap=asap),
            timeout_s,
            lambda states: all(states.get(name) == "active" for name in names),
        )

    def deactivate(self, names: Sequence[str], timeout_s: float) -> bool:
        """Deactivate all of these in one strict switch; return whether they are."""
        return self._switch(
            SwitchController.Request(deactivate_controllers=list(names)),
            timeout_s,
            lambda states: all(states.get(name) != "active" for name in names),
        )

    def _switch(
        self,
        request: SwitchController.Request,
        timeout_s: float,
        is_done: Callable[[Mapping[str, str]], bool],
    ) -> bool:
        request.strictness = SwitchController.Request.STRICT
        seconds = int(timeout_s)
        request.timeout = Duration(sec=seconds, nanosec=round((timeout_s - seconds) * 1e9))
        return self._change("switch_controller", request, is_done)

    def _change(
        self,
        service: str,
        request: Any,
        is_done: Callable[[Mapping[str, str]], bool],
    ) -> bool:
        """Ask for a change; return whether it was made."""
        for _ in range(ATTEMPTS):
            answer = self._try_call(service, request, self._timeout_s)
            if answer is not None:
                message = getattr(answer, "message", "")
                if not answer.ok and message:
                    logger.error("%s", message)
                return answer.ok
            if is_done(self.states()):
                return True
        raise self._no_answer(service)

    def _query(self, service: str, request: Any) -> Any:
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
        self._wait_for_service(client, self._timeout_s)
        answered = threading.Event()
        future = client.call_async(request)
        future.add_done_callback(lambda _: answered.set())
        clock = MonotonicClock()
        deadline_s = clock.now_s() + timeout_s
        while not answered.wait(POLL_S):
            self._check_interrupted()
            if clock.now_s() >= deadline_s:
                client.remove_pending_request(future)
                logger.warning("no answer from %s within %g s", client.srv_name, timeout_s)
                return None
        return future.result()

    def _wait_for_service(self, client: Client, timeout_s: float) -> None:
        # Not Client.wait_for_service: it looks four times a second only, and cannot be ended.
        clock = MonotonicClock()
        start_s = clock.now_s()
        throttle = Throttle(REPORT_INTERVAL_S, clock)
        while not client.service_is_ready():
            waited_s = clock.now_s() - start_s
            if timeout_s and waited_s >= timeout_s:
                raise ManagerUnreachableError(
                    f"no service {client.srv_name} after {timeout_s:g} s; is a controller "
                    f"manager named {self._manager} running, in this ROS domain?"
                )
            if waited_s >= PATIENCE_S and throttle.permits():
                logger.info("waiting for service %s", client.srv_name)
            self._check_interrupted()
            time.sleep(POLL_S)

    def _check_interrupted(self) -> None:
        if self._interrupted():
            raise InterruptedCallError("interrupted")

    def _no_answer(self, service: str) -> ManagerUnreachableError:
        return ManagerUnreachableError(
            f"{self._manager}/{service} did not answer {ATTEMPTS} times within "
            f"{self._timeout_s:g} s each"
        )
