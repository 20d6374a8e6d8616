"""A plain node whose parameters are described by a dataclass."""

import logging
from collections.abc import Iterable, Mapping
from types import MappingProxyType
from typing import Any

from rcl_interfaces.msg import (
    FloatingPointRange,
    IntegerRange,
    ParameterDescriptor,
    SetParametersResult,
)
from rclpy.node import Node
from rclpy.parameter import Parameter

from arm_control.errors import ParameterError
from arm_control.manager.controller_creation import given_value, strings_of, unknown_parameters
from arm_control.parameters import ParameterSpec

_LIST_TYPES = {
    bool: Parameter.Type.BOOL_ARRAY,
    int: Parameter.Type.INTEGER_ARRAY,
    float: Parameter.Type.DOUBLE_ARRAY,
    str: Parameter.Type.STRING_ARRAY,
}
_MAX_INT = 2**63 - 1


class ParameterNode(Node):
    """A node with declared parameters and access to the given ones.

    It accepts an integer for a float parameter, which rclpy refuses, and an empty list, which rclpy
    loses.
    """

    def given_parameters(self) -> dict[str, Any]:
        """Return this node's parameters from files and arguments; None for an empty list."""
        # rclpy offers no other access to values that are not yet declared.
        return {name: given.value for name, given in self._parameter_overrides.items()}

    _rules: Mapping[str, ParameterSpec] = MappingProxyType({})

    def set_parameters_atomically(self, parameter_list: list[Parameter]) -> SetParametersResult:
        """Set parameters; refuse a value that breaks its rules, and say what is allowed.

        rclpy would refuse it too, but its reason is harder to understand.
        """
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
        """Declare all other given parameters, such as the types of controllers."""
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
        return strings_of(name, self.get_parameter(name).value)

    def warn_of_unknown(self, known: Iterable[str], owner: str, others: Iterable[str] = ()) -> None:
        """Warn of given parameters that are unknown.

        Args:
            known: names of this node's parameters.
            owner: owner of the parameters, for the message.
            others: names that are known to another node with the same arguments.
        """
        sentence = unknown_parameters(self.given_parameters(), known, owner, others)
        if sentence:
            logging.getLogger(self.get_name()).warning("%s", sentence)

    def values_of(self, specs: Iterable[ParameterSpec]) -> dict[str, Any]:
        """Return the current values of declared parameters."""
        return {spec.name: self.get_parameter(spec.name).value for spec in specs}

    def _declare(self, spec: ParameterSpec, value: Any) -> None:
        if spec.is_list and not value:
            self._declare_empty_list(spec)
            return
        self.declare_parameter(
            spec.name,
            list(value) if spec.is_list else value,
            _descriptor(spec),
            ignore_override=True,
        )

    def _declare_empty_list(self, spec: ParameterSpec) -> None:
        # rclpy cannot infer the type of an empty list, so declare the type, then set the value,
        # then the descriptor.
        kind = _LIST_TYPES[spec.type]
        self.declare_parameter(spec.name, kind, ignore_override=True)
        self.set_parameters([Parameter(spec.name, kind, [])])
        descriptor = _descriptor(spec)
        descriptor.type = kind.value
        self.set_descriptor(spec.name, descriptor)


def _descriptor(spec: ParameterSpec) -> ParameterDescriptor:
    """Return the descriptor of a parameter."""
    descriptor = ParameterDescriptor(
        description=spec.description,
        read_only=spec.read_only,
        additional_constraints=spec.constraint,
    )
    if spec.range is not None and spec.type is int:
        low, high = (int(min(max(bound, -_MAX_INT), _MAX_INT)) for bound in spec.range)
        descriptor.integer_range = [IntegerRange(from_value=low, to_value=high)]
    elif spec.range is not None:
        low, high = map(float, spec.range)
        descriptor.floating_point_range = [FloatingPointRange(from_value=low, to_value=high)]
    return descriptor
