"""A plain node whose parameters are described by a dataclass."""

import logging
from collections.abc import Iterable, Sequence
from typing import Any

from rcl_interfaces.msg import ParameterDescriptor
from rclpy.node import Node
from rclpy.parameter import Parameter

from arm_control.errors import ParameterError
from arm_control.parameters import ParameterSpec

_LIST_TYPES = {
    bool: Parameter.Type.BOOL_ARRAY,
    int: Parameter.Type.INTEGER_ARRAY,
    float: Parameter.Type.DOUBLE_ARRAY,
    str: Parameter.Type.STRING_ARRAY,
}
_ANY_NODE = (
    "fallback_controllers",
    "node_options_args",
    "params_file",
    "robot_description",
    "start_type_description_service",
    "type",
    "use_sim_time",
)
"""What a parameter file may say about any controller, beside the controller's own parameters.

Also after the controller's name and a dot, as the manager takes it.
"""


class ParameterNode(Node):
    """A node that knows which parameters it was given and which it has.

    An integer given for a float parameter is taken, an empty list is a list; rclpy itself refuses
    the one and loses the other.
    """

    def given_parameters(self) -> dict[str, Any]:
        """Return what parameter files and arguments say about this node; None for an empty list."""
        # rclpy has no other way to see values that are not declared yet.
        return {name: given.value for name, given in self._parameter_overrides.items()}

    def declare_specs(self, specs: Iterable[ParameterSpec]) -> None:
        """Declare those that are not yet, each with its given value or its default.

        Raises:
            ParameterError: a given value has the wrong type.
        """
        given = self.given_parameters()
        for spec in specs:
            if self.has_parameter(spec.name):
                continue
            value = given.get(spec.name)
            self._declare(spec, spec.default if value is None else spec.convert(value))

    def declare_rest(self) -> None:
        """Declare whatever else was given, such as the types of controllers."""
        for name, value in self.given_parameters().items():
            if self.has_parameter(name):
                continue
            if value is None:
                self._declare_empty_list(ParameterSpec(name, str, True, (), "", False))
            else:
                self.declare_parameter(
                    name, value, ParameterDescriptor(dynamic_typing=True), ignore_override=True
                )

    def strings(self, name: str) -> tuple[str, ...]:
        """Return a parameter that is one string or several, declared or not; empty for none.

        Raises:
            ParameterError: it is something else.
        """
        value = self.get_parameter(name).value
        if value is None:
            return ()
        if isinstance(value, str):
            return (value,)
        if isinstance(value, Sequence) and all(isinstance(item, str) for item in value):
            return tuple(value)
        raise ParameterError(
            f"parameter '{name}' must be a string or a list of strings, not {value!r}"
        )

    def warn_of_unknown(self, known: Iterable[str], owner: str, others: Iterable[str] = ()) -> None:
        """Say which of the given parameters mean nothing.

        Args:
            known: to this node.
            owner: whose parameters these are, for the message.
            others: what means something to another node that is given the same ones.
        """
        names = sorted(known)
        harmless = {*names, *others}
        unknown = [
            name
            for name in self.given_parameters()
            if name not in harmless
            and name.rpartition(".")[2] not in _ANY_NODE
            and not name.startswith("qos_overrides.")
        ]
        if unknown:
            logging.getLogger(self.get_name()).warning(
                "parameter %s is not known to %s and has no effect; it knows %s",
                ", ".join(f"'{name}'" for name in sorted(unknown)),
                owner,
                ", ".join(names),
            )

    def values_of(self, specs: Iterable[ParameterSpec]) -> dict[str, Any]:
        """Return the present values of declared parameters."""
        return {spec.name: self.get_parameter(spec.name).value for spec in specs}

    def _declare(self, spec: ParameterSpec, value: Any) -> None:
        if spec.is_list and not value:
            self._declare_empty_list(spec)
            return
        self.declare_parameter(
            spec.name,
            list(value) if spec.is_list else value,
            ParameterDescriptor(
                description=spec.description,
                read_only=spec.read_only,
                additional_constraints=spec.constraint,
            ),
            ignore_override=True,
        )

    def _declare_empty_list(self, spec: ParameterSpec) -> None:
        # An empty list tells rclpy no type, so: the type first, then the value, then the rules.
        kind = _LIST_TYPES[spec.type]
        self.declare_parameter(spec.name, kind, ignore_override=True)
        self.set_parameters([Parameter(spec.name, kind, [])])
        self.set_descriptor(
            spec.name,
            ParameterDescriptor(
                type=kind.value, description=spec.description, read_only=spec.read_only
            ),
        )
