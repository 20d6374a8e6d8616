"""Starts controllers in a program without ROS, from the parameters that their nodes would get."""

import logging
from collections.abc import Mapping
from typing import Any

from arm_control.controllers.controller import Controller, ControllerContext
from arm_control.errors import ControllerManagerError, ParameterError
from arm_control.manager.controller_creation import (
    create_controller,
    general_specs,
    given_values,
    only_type,
    parameters_of,
    requested_rate_hz,
    strings_of,
    unknown_parameters,
)
from arm_control.manager.controller_manager import ControllerManager
from arm_control.manager.parameter_file import ControllerParameterFile, ParametersByNode
from arm_control.manager.settings import ManagerSettings
from arm_control.manager.switch_planner import Strictness, SwitchRequest
from arm_control.parameters import build_parameters, known_parameters, specs_of
from arm_description.urdf.description import Description

MANAGER = "controller_manager"
ROOT = "/"

logger = logging.getLogger("controller_manager")


def manager_settings(parameters: ParametersByNode) -> ManagerSettings:
    """Return the settings of a controller manager in the root namespace.

    Args:
        parameters: a parameter file's content.

    Raises:
        ParameterError: a parameter has the wrong type or value.
    """
    given = parameters.given(MANAGER, ROOT)
    return build_parameters(ManagerSettings, given_values(specs_of(ManagerSettings), given))


class ControllerStarter:
    """Loads, configures and activates controllers on the thread that owns the manager.

    What `/controller_manager` does for a spawner, without nodes: a controller's topics, services
    and actions do not exist, and its core takes commands from the program.
    """

    def __init__(
        self,
        manager: ControllerManager,
        parameters: ParametersByNode,
        robot_description: Description = "",
        namespace: str = ROOT,
    ) -> None:
        """Take a manager whose components are already brought up.

        Args:
            manager: runs the controllers.
            parameters: a parameter file's content: types and parameters of controllers.
            robot_description: URDF for the controllers.
            namespace: the manager's namespace, with the leading slash.
        """
        self._manager = manager
        self._parameters = parameters
        self._robot_description = robot_description
        self._namespace = namespace
        self._of_manager = parameters.given(MANAGER, namespace)
        self._changes: dict[str, dict[str, object]] = {}

    def start(self, name: str) -> Controller[Any]:
        """Load, configure and activate a controller.

        Raises:
            ArmControlError: it cannot start; the message says why.
        """
        controller = self.load(name)
        self.configure(controller)
        self.activate(name)
        return controller

    def load(self, name: str) -> Controller[Any]:
        """Create a controller; the manager's parameter `<name>.type` is its type.

        Raises:
            ArmControlError: its type is unknown, or its name is taken.
        """
        types = self._strings(f"{name}.type") or self._own_type(name)
        type_name = only_type(name, types, self._of_manager)
        context = ControllerContext.of(name, self._manager.update_rate_hz, self._robot_description)
        controller = create_controller(type_name, context)
        fallbacks = self._strings(f"{name}.fallback_controllers")
        self._manager.load_controller(controller, type_name, fallbacks)
        return controller

    def configure(self, controller: Controller[Any]) -> None:
        """Configure a loaded controller with its parameters.

        Raises:
            ArmControlError: a parameter is wrong, or the controller refuses.
        """
        name = controller.name
        given = self._given(name)
        with parameters_of(name):
            specs = controller.parameter_specs(given)
            general = given_values(general_specs(self._manager.update_rate_hz), given)
            parameters = controller.build_parameters(given_values(specs, given))
            rate_hz = requested_rate_hz(name, general)
        known = [*(spec.name for spec in specs), *general]
        others = [spec.name for spec in specs_of(ManagerSettings)]
        sentence = unknown_parameters(given, known, type(controller).__name__, others)
        if sentence:
            logging.getLogger(name).warning("%s", sentence)
        self._manager.configure_controller(name, parameters, rate_hz)

    def change(self, controller: Controller[Any], changes: Mapping[str, object]) -> None:
        """Change parameters of a configured controller, as `ros2 param set` does.

        Raises:
            ArmControlError: a parameter is unknown or wrong, or cannot be changed now.
        """
        name = controller.name
        given = {**self._given(name), **changes}
        with parameters_of(name):
            specs = {spec.name: spec for spec in controller.parameter_specs(given)}
            for changed in changes:
                if changed not in specs:
                    raise ParameterError(
                        f"unknown parameter {changed}; {known_parameters(changed, specs)}"
                    )
                if specs[changed].read_only:
                    raise ParameterError(f"parameter '{changed}' is read-only")
                if specs[changed].at_configuration:
                    raise ParameterError(
                        f"parameter '{changed}' takes effect only when the controller is configured"
                    )
            parameters = controller.build_parameters(given_values(specs.values(), given))
        controller.change_parameters(parameters)
        self._changes.setdefault(name, {}).update(changes)

    def activate(self, name: str) -> None:
        """Activate a configured controller.

        Raises:
            ControllerManagerError: it cannot be activated.
        """
        request = SwitchRequest(activate=(name,), strictness=Strictness.STRICT)
        result = self._manager.switch_controller(request)
        if not result.ok:
            raise ControllerManagerError(result.message)

    def _given(self, name: str) -> dict[str, Any]:
        given = self._parameters.given(name, self._namespace)
        for path in self._strings(f"{name}.params_file"):
            given.update(ControllerParameterFile(path).given(name, self._namespace))
        if self._strings(f"{name}.node_options_args"):
            logger.warning("'%s.node_options_args' has no effect: there is no node", name)
        return {**given, **self._changes.get(name, {})}

    def _own_type(self, name: str) -> tuple[str, ...]:
        """Return the type in the controller's own entry, if any."""
        value = self._parameters.own_entry(name, self._namespace, "type")
        return (value,) if isinstance(value, str) else ()

    def _strings(self, name: str) -> tuple[str, ...]:
        """Return a parameter of the manager that is one string or several; empty for none."""
        return strings_of(name, self._of_manager.get(name))
