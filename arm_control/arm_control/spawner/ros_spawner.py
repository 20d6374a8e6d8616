"""The work of spawner, unspawner and hardware_spawner: requests to a controller manager.

They are sent from a thread that may wait, and sent again if there is no answer.
"""

import logging
import math
import threading
import time
from collections.abc import Callable, Iterable, Sequence
from typing import Any

from rclpy.client import Client
from rclpy.exceptions import NameValidationException
from rclpy.node import Node

from arm_control.errors import ManagerUnreachableError, SpawnError, WaitInterruptedError
from arm_control.loop.clock import MonotonicClock, Throttle
from arm_control.manager.parameter_file import ControllerParameterFile, manager_parameters
from arm_control.spawner.command_line import (
    ControllerOptions,
    HardwareSpawnerOptions,
    SpawnerOptions,
    UnspawnerOptions,
    absolute_name,
)
from arm_control.spawner.spawner_lock import spawner_lock, spawner_lock_path
from arm_node.controller_manager import SERVICES, ControllerManagerClient
from arm_node.printable import first_line
from arm_node.process import EXIT_FAILED, EXIT_OK, NodeProcess

SERVICE_CALL_TIMEOUT_S = 10.0
UNLOAD_TIMEOUT_S = 2.0
UNLOAD_SERVICES = ("list_controllers", "switch_controller", "unload_controller")
SPAWN_SERVICES = (*UNLOAD_SERVICES, "configure_controller", "load_controller", "set_parameters")
HARDWARE_SERVICES = ("list_hardware_components", "set_hardware_component_state")
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

        After `timeout_s` without an answer a client asks again; `interrupted` tells whether to
        stop.

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

        The answer has the field `ok`. `is_done` checks whether the change was made although no
        answer came.
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


def unspawn(node: Node, process: NodeProcess, options: UnspawnerOptions) -> int:
    """Unload controllers; return the process's exit code. Not on an executor's thread."""
    caller = RetryingCaller(
        node,
        absolute_name(options.controller_manager, node.get_namespace()),
        UNLOAD_SERVICES,
        SERVICE_CALL_TIMEOUT_S,
        lambda: process.stopping,
    )
    caller.wait_for("list_controllers", 0.0)
    manager = ControllerManagerClient(caller)
    log = logging.getLogger(node.get_logger().name)
    states = manager.states()
    active = [name for name in options.names if states.get(name) == "active"]
    others = [name for name in options.names if name not in active]
    if active and others:
        # As in ros2_control, whose strict switch refuses to deactivate an inactive controller.
        log.error(
            "Nothing is unloaded: %s is active, but %s is not", " ".join(active), " ".join(others)
        )
        return EXIT_FAILED
    return unload_controllers(manager, options.names, options.switch_timeout_s, log)


def unload_controllers(
    manager: ControllerManagerClient,
    names: Sequence[str],
    switch_timeout_s: float,
    log: logging.Logger,
) -> int:
    """Deactivate the active ones in one switch, then unload all; return the exit code.

    A controller that cannot be deactivated cannot be unloaded either, and unloading reports it.
    """
    states = manager.states()
    active = [name for name in names if states.get(name) == "active"]
    if active and manager.switch(deactivate=active, timeout_s=switch_timeout_s).ok:
        log.info("Deactivated controllers: %s", " ".join(active))
    code = EXIT_OK
    for name in names:
        if manager.unload(name):
            log.info("Unloaded controller %s", name)
        else:
            log.error("Failed to unload controller %s", name)
            code = EXIT_FAILED
    return code


def spawn_hardware(node: Node, process: NodeProcess, options: HardwareSpawnerOptions) -> int:
    """Bring the components to their state; return the exit code. Not on an executor's thread.

    As in ros2_control, a component that is missing or fails causes only a warning: the exit code
    says only whether the manager answered.
    """
    log = logging.getLogger(node.get_logger().name)
    manager = absolute_name(options.controller_manager, node.get_namespace())
    caller = RetryingCaller(
        node, manager, HARDWARE_SERVICES, SERVICE_CALL_TIMEOUT_S, lambda: process.stopping
    )
    caller.wait_for("list_hardware_components", options.controller_manager_timeout_s)
    client = ControllerManagerClient(caller)
    target = options.target.label
    states = client.component_states()
    for name in options.names:
        if name not in states:
            log.warning(
                "Hardware Component is not loaded - state can not be changed: %s; %s has %s",
                name,
                manager,
                ", ".join(states) or "none",
            )
        elif client.set_component_state(name, target).ok:
            state = client.component_states()[name]
            log.info("component '%s': Hardware now in state: %s.", name, state)
        else:
            log.warning(
                "Could not bring component '%s' to state %s; it is in state %s, and the reason is "
                "in the log of %s",
                name,
                target,
                client.component_states()[name].label,
                manager,
            )
    return EXIT_OK


class _Spawner:
    """Loads, configures and activates controllers. Not on an executor's thread."""

    def __init__(self, node: Node, process: NodeProcess, options: SpawnerOptions) -> None:
        """Prepare.

        Raises:
            SpawnError: the namespace is given twice.
            ParameterError: a parameter file cannot be read.
        """
        self._node = node
        self._process = process
        self._options = options
        self._log = logging.getLogger(node.get_logger().name)
        self._namespace = f"/{self._chosen_namespace().strip('/')}"
        self._manager_name = absolute_name(options.controller_manager, self._namespace)
        self._files = {
            path: ControllerParameterFile(path)
            for controller in options.controllers
            for path in controller.param_files
        }
        self._caller = RetryingCaller(
            node,
            self._manager_name,
            SPAWN_SERVICES,
            options.service_call_timeout_s,
            lambda: process.stopping,
        )
        self._manager = ControllerManagerClient(self._caller)

    def run(self) -> int:
        """Start the controllers; return the process's exit code.

        Raises:
            ArmControlError: a step failed.
        """
        self._caller.wait_for("list_controllers", self._options.controller_manager_timeout_s)
        # Only after the manager has answered: while it waits, a spawner must not block all others.
        with spawner_lock(spawner_lock_path(), self._process.wait):
            self._start()
        if not self._options.unload_on_kill:
            return EXIT_OK
        self._log.info("Waiting until interrupt to unload controllers")
        self._process.wait()
        return self._unload()

    def _unload(self) -> int:
        names = [c.name for c in self._options.controllers if c.unload_on_kill]
        # A new caller, because the first one has been interrupted.
        caller = RetryingCaller(self._node, self._manager_name, UNLOAD_SERVICES, UNLOAD_TIMEOUT_S)
        manager = ControllerManagerClient(caller)
        return unload_controllers(manager, names, UNLOAD_TIMEOUT_S, self._log)

    def _start(self) -> None:
        options = self._options
        for controller in options.controllers:
            self._load(controller)
            if not controller.configure:
                continue
            name = controller.name
            if not self._manager.configure(name):
                raise SpawnError(f"Failed to configure controller {name}; {self._see_log()}")
            if not controller.activate:
                self._log.info("Configured %s", name)
            elif not options.activate_as_group:
                self._activate([name])
                self._log.info("Configured and activated %s", name)
        group = [controller.name for controller in options.controllers if controller.activate]
        if options.activate_as_group and group:
            self._activate(group)
            self._log.info("Configured and activated all the parsed controllers list : %s!", group)

    def _load(self, controller: ControllerOptions) -> None:
        name = controller.name
        if name in self._manager.states():
            self._log.warning(
                "Controller already loaded, skipping load_controller: %s keeps its parameters", name
            )
            return
        parameters = self._manager_parameters(controller)
        if parameters:
            reason = self._manager.set_parameters(parameters)
            if reason:
                raise SpawnError(f"{self._manager_name} refuses the parameters of {name}: {reason}")
        if not self._manager.load(name):
            raise SpawnError(f"Failed loading controller {name}; {self._see_log()}")
        self._log.info("Loaded %s", name)

    def _activate(self, names: Sequence[str]) -> None:
        timeout_s, asap = self._options.switch_timeout_s, self._options.switch_asap
        if not self._manager.switch(names, asap=asap, timeout_s=timeout_s).ok:
            raise SpawnError(
                f"Failed to activate controller : {' '.join(names)}; {self._see_log()}"
            )

    def _manager_parameters(self, controller: ControllerOptions) -> dict[str, str | Sequence[str]]:
        """Return the manager's parameters that it needs before it loads the controller."""
        name = controller.name
        parameters: dict[str, str | Sequence[str]] = {}
        if controller.ros_args:
            parameters[f"{name}.node_options_args"] = controller.ros_args
        files = [self._files[path] for path in dict.fromkeys(controller.param_files)]
        return parameters | manager_parameters(name, self._namespace, files)

    def _chosen_namespace(self) -> str:
        own, given = self._node.get_namespace(), self._options.namespace
        if not given:
            return own
        if own != "/":
            raise SpawnError(
                f"the namespace is given twice, by --namespace {given} and by __ns:={own}"
            )
        self._log.warning(
            "--namespace is deprecated; write --ros-args -r __ns:=/%s", given.strip("/")
        )
        return given

    def _see_log(self) -> str:
        return f"the reason is in the log of {self._manager_name}"


def spawn(node: Node, process: NodeProcess, options: SpawnerOptions) -> int:
    """Start controllers; return the process's exit code. Not on an executor's thread.

    Raises:
        ArmControlError: a step failed.
    """
    return _Spawner(node, process, options).run()
