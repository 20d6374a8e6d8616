"""Creates controllers from their parameters, and starts them in a program without ROS."""

import logging
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any

from arm_control.controllers.controller import Controller, ControllerContext
from arm_control.errors import ArmControlError, ControllerManagerError, ParameterError
from arm_control.manager.controller_manager import ControllerManager
from arm_control.manager.parameter_file import ControllerParameterFile, ParametersByNode
from arm_control.manager.registry import controller_class
from arm_control.manager.settings import ManagerSettings
from arm_control.manager.switch_planner import Strictness, SwitchRequest
from arm_control.parameters import ParameterSpec, build_parameters, known_parameters, specs_of
from arm_description.urdf.description import Description
from arm_node.names import listing
from arm_node.printable import first_line

MANAGER = "controller_manager"
ROOT = "/"

logger = logging.getLogger("controller_manager")

_OF_ANY_CONTROLLER = (
    "fallback_controllers",
    "node_options_args",
    "params_file",
    "robot_description",
    "start_type_description_service",
    "type",
    "use_sim_time",
)
"""Parameters that a file may give for any controller besides the controller's own.

The manager accepts them after the controller's name and a dot.
"""


def only_type(name: str, types: Sequence[str], parameters: Iterable[str]) -> str:
    """Return the type of a controller from the values that its parameter has.

    Raises:
        ControllerManagerError: it has none, or several.
    """
    if len(types) != 1:
        suffix = ".type"
        named = [each.removesuffix(suffix) for each in parameters if each.endswith(suffix)]
        raise ControllerManagerError(
            f"The 'type' param was not defined for '{name}'. It is defined for "
            f"{listing(sorted(named))}."
        )
    return types[0]


def create_controller(type_name: str, context: ControllerContext) -> Controller[Any]:
    """Return a new, unconfigured controller.

    Raises:
        ArmControlError: its type is unknown, or it cannot be created.
    """
    try:
        return controller_class(type_name)(context)
    except ArmControlError:
        raise
    except Exception as error:
        # A constructor may raise anything. Only the author of a controller needs the traceback.
        logger.exception("controller '%s' cannot be created", context.name)
        raise not_created(context.name, error) from error


def not_created(name: str, error: Exception) -> ControllerManagerError:
    """Return the error of a controller whose creation raised something unexpected."""
    return ControllerManagerError(
        f"controller '{name}' cannot be created: {type(error).__name__}: {first_line(error)}"
    )


def general_specs(update_rate_hz: int) -> tuple[ParameterSpec, ...]:
    """Return the parameters that every controller has; the manager's rate is the default."""
    return tuple(
        ParameterSpec(name, type(default), False, default, description, read_only=False)
        for name, default, description in (
            ("update_rate", update_rate_hz, "Updates per second"),
            ("is_async", False, "No effect: controllers run in the control loop"),
            ("thread_priority", -100, "No effect; ros2_control has it"),
        )
    )


def given_values(specs: Iterable[ParameterSpec], given: Mapping[str, Any]) -> dict[str, Any]:
    """Return the values of parameters: the given ones, and the defaults of all others.

    Raises:
        ParameterError: a given value has the wrong type.
    """
    return {spec.name: given_value(spec, given) for spec in specs}


def given_value(spec: ParameterSpec, given: Mapping[str, Any]) -> Any:
    """Return the value of a parameter; a given None counts as not given."""
    value = given.get(spec.name)
    return spec.default if value is None else spec.convert(value)


def requested_rate_hz(name: str, values: Mapping[str, Any]) -> int:
    """Return the update rate that a controller's `general_specs` ask for.

    Raises:
        ParameterError: it is not a rate.
    """
    rate_hz = values["update_rate"]
    if not isinstance(rate_hz, int) or rate_hz < 0:
        raise ParameterError(f"parameter 'update_rate' must not be negative, but is {rate_hz}")
    if values["is_async"]:
        logging.getLogger(name).warning(
            "parameter 'is_async' has no effect: controllers run in the control loop"
        )
    return rate_hz


def unknown_parameters(
    given: Iterable[str], known: Iterable[str], owner: str, others: Iterable[str] = ()
) -> str:
    """Return a sentence about given parameters that are unknown; empty if there are none.

    The names of `others` are known to another node with the same parameters.
    """
    names = sorted(known)
    harmless = {*names, *others}
    unknown = [
        name
        for name in given
        if name not in harmless
        and name.rpartition(".")[2] not in _OF_ANY_CONTROLLER
        and not name.startswith("qos_overrides.")
    ]
    if not unknown:
        return ""
    return (
        f"parameter {', '.join(repr(name) for name in sorted(unknown))} is not known to {owner} "
        f"and has no effect; {known_parameters(sorted(unknown)[0], names)}"
    )


def strings_of(name: str, value: object) -> tuple[str, ...]:
    """Return the value of a parameter that is one string or several; empty for None.

    Raises:
        ParameterError: it is something else.
    """
    if value is None:
        return ()
    if isinstance(value, str):
        return (value,)
    if isinstance(value, Sequence) and all(isinstance(item, str) for item in value):
        return tuple(value)
    raise ParameterError(f"parameter '{name}' must be a string or a list of strings, not {value!r}")


@contextmanager
def parameters_of(name: str) -> Iterator[None]:
    """Add the controller's name to errors about its parameters."""
    try:
        yield
    except ParameterError as error:
        raise ParameterError(f"controller '{name}': {error}") from error


def manager_settings(parameters: ParametersByNode) -> ManagerSettings:
    """Return the settings of a controller manager in the root namespace.

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
        """Take a manager in a namespace, such as '/left', whose components are brought up."""
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
        types = self._strings(f"{name}.type")
        types = types or self._parameters.own_type(name, self._namespace)
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

    def _strings(self, name: str) -> tuple[str, ...]:
        """Return a parameter of the manager that is one string or several; empty for none."""
        return strings_of(name, self._of_manager.get(name))
