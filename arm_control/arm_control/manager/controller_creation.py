"""Creates controllers: their type, their object and the values of their parameters."""

import logging
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any

from arm_control.controllers.controller import Controller, ControllerContext
from arm_control.errors import ArmControlError, ControllerManagerError, ParameterError
from arm_control.manager.registry import controller_class
from arm_control.parameters import ParameterSpec, known_parameters
from arm_node.names import listing
from arm_node.printable import first_line

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

    Args:
        name: the controller's name.
        types: the values.
        parameters: names of the manager's parameters, for the message.

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

    Args:
        given: names of the given parameters.
        known: names of the node's parameters.
        owner: owner of the parameters.
        others: names that are known to another node with the same parameters.
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
