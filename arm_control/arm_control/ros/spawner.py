"""Starts controllers through the services of a controller manager."""

import logging
from collections.abc import Callable, Sequence
from typing import Any

from rclpy.node import Node

from arm_control.controller_parameter_file import ControllerParameterFile
from arm_control.errors import ArmControlError, ParameterError
from arm_control.ros.manager_client import InterruptedCallError, ManagerClient
from arm_control.spawner_options import SpawnerOptions
from arm_node.process import EXIT_FAILED, EXIT_OK

UNLOAD_TIMEOUT_S = 2.0


class SpawnError(ArmControlError):
    """A step failed; the message says which."""


class Spawner:
    """Loads, configures and activates what its options name. Not on an executor's thread."""

    def __init__(
        self, node: Node, options: SpawnerOptions, interrupted: Callable[[], bool]
    ) -> None:
        """Prepare.

        Args:
            node: for the service clients; served by a spinning executor.
            options: what to do.
            interrupted: says whether to give up.
        """
        self._node = node
        self._options = options
        self._log = logging.getLogger(node.get_name())
        self._namespace = options.namespace or node.get_namespace()
        if not self._namespace.startswith("/"):
            self._namespace = f"/{self._namespace}"
        manager = options.controller_manager
        if not manager.startswith("/"):
            manager = f"{self._namespace.rstrip('/')}/{manager}"
        self._manager_name = manager
        self._manager = ManagerClient(node, manager, options.service_call_timeout_s, interrupted)

    def run(self) -> int:
        """Do it all; return the process's exit code."""
        try:
            files = [ControllerParameterFile(path) for path in self._options.param_files]
            self._manager.wait_for_manager(self._options.controller_manager_timeout_s)
            self._start(files)
        except InterruptedCallError:
            return EXIT_OK
        except ArmControlError as error:
            self._log.critical("%s", error)
            return EXIT_FAILED
        return EXIT_OK

    def unload(self) -> None:
        """Deactivate and unload what was started, as far as that is possible."""
        names = self._options.names
        self._log.info("unloading %s", " ".join(names))
        manager = ManagerClient(self._node, self._manager_name, UNLOAD_TIMEOUT_S)
        try:
            if not self._options.inactive and not self._options.load_only:
                manager.deactivate(names, UNLOAD_TIMEOUT_S)
            for name in names:
                if manager.unload(name):
                    self._log.info("Unloaded %s", name)
                else:
                    self._log.error("Failed to unload controller %s", name)
        except ArmControlError as error:
            self._log.error("the controllers were not unloaded: %s", error)

    def _start(self, files: Sequence[ControllerParameterFile]) -> None:
        options = self._options
        for name in options.names:
            self._load(name, files)
            if options.load_only:
                continue
            if not self._manager.configure(name):
                raise SpawnError(f"Failed to configure controller {name}; {self._see_log()}")
            if options.inactive:
                self._log.info("Configured %s", name)
            elif not options.activate_as_group:
                self._activate([name])
                self._log.info("Configured and activated %s", name)
        if options.activate_as_group and not (options.load_only or options.inactive):
            self._activate(options.names)
            self._log.info("Configured and activated all the parsed controllers list!")

    def _load(self, name: str, files: Sequence[ControllerParameterFile]) -> None:
        if name in self._manager.states():
            self._log.warning(
                "Controller already loaded, skipping load_controller: %s keeps its parameters", name
            )
            return
        parameters = self._manager_parameters(name, files)
        if parameters:
            reason = self._manager.set_parameters(parameters)
            if reason:
                raise SpawnError(
                    f"{self._manager_name} does not take the parameters of {name}: {reason}"
                )
        if not self._manager.load(name):
            raise SpawnError(f"Failed loading controller {name}; {self._see_log()}")
        self._log.info("Loaded %s", name)

    def _activate(self, names: Sequence[str]) -> None:
        timeout_s, asap = self._options.switch_timeout_s, self._options.switch_asap
        if not self._manager.activate(names, timeout_s, asap=asap):
            raise SpawnError(
                f"Failed to activate controller : {' '.join(names)}; {self._see_log()}"
            )

    def _manager_parameters(
        self, name: str, files: Sequence[ControllerParameterFile]
    ) -> dict[str, str | Sequence[str]]:
        """Return what the manager must know before it loads the controller."""
        parameters: dict[str, str | Sequence[str]] = {}
        if self._options.controller_ros_args:
            parameters[f"{name}.node_options_args"] = self._options.controller_ros_args
        if files:
            parameters[f"{name}.params_file"] = [str(file.path) for file in files]
        type_name = self._from_files(name, files, "type")
        if type_name is not None:
            if not isinstance(type_name, str):
                raise ParameterError(f"the type of controller '{name}' is {type_name!r}")
            parameters[f"{name}.type"] = type_name
        fallbacks = self._from_files(name, files, "fallback_controllers")
        if fallbacks is not None:
            if not isinstance(fallbacks, list) or not all(isinstance(f, str) for f in fallbacks):
                raise ParameterError(
                    f"fallback_controllers of controller '{name}' must be a list of names, "
                    f"not {fallbacks!r}"
                )
            parameters[f"{name}.fallback_controllers"] = fallbacks
        return parameters

    def _from_files(
        self, name: str, files: Sequence[ControllerParameterFile], parameter: str
    ) -> Any:
        values = (file.lookup(name, self._namespace, parameter) for file in files)
        return next((value for value in values if value is not None), None)

    def _see_log(self) -> str:
        return f"the reason is in the log of {self._manager_name}"
