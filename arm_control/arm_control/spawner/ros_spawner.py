"""Starts controllers through the services of a controller manager."""

import logging
from collections.abc import Sequence

from rclpy.node import Node

from arm_control.errors import SpawnError
from arm_control.manager.parameter_file import ControllerParameterFile, manager_parameters
from arm_control.spawner.command_line import absolute_name
from arm_control.spawner.ros_retrying_caller import RetryingCaller
from arm_control.spawner.ros_unspawner import UNLOAD_SERVICES, unload_controllers
from arm_control.spawner.spawner_lock import spawner_lock, spawner_lock_path
from arm_control.spawner.spawner_options import ControllerOptions, SpawnerOptions
from arm_node.controller_manager import ControllerManagerClient
from arm_node.process import EXIT_OK, NodeProcess

UNLOAD_TIMEOUT_S = 2.0
SERVICES = (*UNLOAD_SERVICES, "configure_controller", "load_controller", "set_parameters")


class _Spawner:
    """Loads, configures and activates controllers. Not on an executor's thread."""

    def __init__(self, node: Node, process: NodeProcess, options: SpawnerOptions) -> None:
        """Prepare.

        Args:
            node: node of the service clients; a spinning executor serves it.
            process: tells when the process must end.
            options: the spawner's options.

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
            SERVICES,
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
