"""A plain node whose parameters are described by a dataclass."""

import logging
from collections.abc import Iterable, Mapping
from types import MappingProxyType
from typing import Any

from rcl_interfaces.msg import ParameterDescriptor, SetParametersResult
from rclpy.node import Node
from rclpy.parameter import Parameter

from arm_control.errors import ParameterError
from arm_control.manager.controller_creation import given_value, strings_of, unknown_parameters
from arm_control.parameters import ParameterSpec
from arm_node.parameters import declare_typed, given_parameters, in_its_type, type_of

UNKNOWN = "Given, but not known to this node"
TYPE_OF_CONTROLLER = "Type of the controller"
OF_CONTROLLERS = {
    "type": TYPE_OF_CONTROLLER,
    "params_file": "Parameter files of the controller",
    "fallback_controllers": "Controllers to activate if an update of this one fails",
    "node_options_args": "ROS arguments for the controller's node",
}
"""Of what a file gives for a controller, by the part of the name behind the controller's."""


class ParameterNode(Node):
    """A node with declared parameters and access to the given ones.

    It accepts an integer for a float parameter, which rclpy refuses, and an empty list, which rclpy
    loses.
    """

    def given_parameters(self) -> dict[str, Any]:
        """Return this node's parameters from files and arguments; None for an empty list."""
        return given_parameters(self)

    _rules: Mapping[str, ParameterSpec] = MappingProxyType({})

    def set_parameters_atomically(self, parameter_list: list[Parameter]) -> SetParametersResult:
        """Set parameters; refuse a value that breaks its rules, and say what is allowed.

        rclpy would refuse it too, but its reason is harder to understand. An empty list may come
        as a list of any type.
        """
        parameter_list = [x if x.value else in_its_type(self, x) for x in parameter_list]
        try:
            for item in parameter_list:
                spec = self._rules.get(item.name)
                if spec is not None and item.type_ is not Parameter.Type.NOT_SET:
                    spec.convert(item.value)
        except ParameterError as error:
            return SetParametersResult(successful=False, reason=str(error))
        return super().set_parameters_atomically(parameter_list)

    def describe_parameter(self, name: str) -> ParameterDescriptor:
        """Return a parameter's descriptor; a dynamically typed one gets its current type."""
        descriptor = super().describe_parameter(name)
        if not descriptor.dynamic_typing or not self.has_parameter(name):
            return descriptor
        return ParameterDescriptor(
            name=name,
            type=self.get_parameter(name).type_.value,
            description=descriptor.description,
            dynamic_typing=True,
        )

    def declare_specs(self, specs: Iterable[ParameterSpec]) -> None:
        """Declare the undeclared ones, each with its given value or its default.

        Raises:
            ParameterError: a given value has the wrong type.
        """
        given = self.given_parameters()
        for spec in specs:
            if self.has_parameter(spec.name):
                continue
            self._declare(spec, given_value(spec, given))
            if not spec.read_only:
                self._rules = {**self._rules, spec.name: spec}

    def declare_rest(self) -> None:
        """Declare all other given parameters, such as the types of controllers, as they are."""
        for name, value in self.given_parameters().items():
            if self.has_parameter(name):
                continue
            own = () if value is None else value
            about = OF_CONTROLLERS.get(name.rpartition(".")[2], UNKNOWN)
            declare_typed(self, name, type_of(own), own, about)

    def strings(self, name: str) -> tuple[str, ...]:
        """Return a parameter that is one string or several, declared or not; empty for none.

        Raises:
            ParameterError: it is something else.
        """
        return strings_of(name, self.get_parameter(name).value)

    def warn_of_unknown(self, known: Iterable[str], owner: str, others: Iterable[str] = ()) -> None:
        """Warn of given parameters that are unknown.

        The `others` are known to another node with the same arguments.
        """
        sentence = unknown_parameters(self.given_parameters(), known, owner, others)
        if sentence:
            logging.getLogger(self.get_name()).warning("%s", sentence)

    def values_of(self, specs: Iterable[ParameterSpec]) -> dict[str, Any]:
        """Return the current values of declared parameters."""
        return {spec.name: self.get_parameter(spec.name).value for spec in specs}

    def _declare(self, spec: ParameterSpec, value: Any) -> None:
        declare_typed(
            self,
            spec.name,
            type_of(spec.default, spec.type if spec.is_list else None),
            value or () if spec.is_list else value,
            spec.description,
            spec.constraint,
            read_only=spec.read_only,
            bounds=spec.range,
        )
