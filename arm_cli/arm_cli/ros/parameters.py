"""The parameters of a node: its services, and values as text and Python values."""

from collections.abc import Mapping, Sequence
from typing import Any

from rcl_interfaces.msg import Parameter, ParameterDescriptor, ParameterValue
from rcl_interfaces.srv import (
    DescribeParameters,
    GetParameters,
    ListParameters,
    SetParameters,
)

from arm_cli.errors import NoSuchNameError
from arm_cli.ros.graph import NodeName
from arm_cli.ros.service_call import ANSWER_TIMEOUT_S, SERVER_TIMEOUT_S, call_service
from arm_cli.ros.session import CommandSession
from arm_node.limited_yaml import YamlError, load_yaml
from arm_node.names import describe_known

TYPE_NAMES = (
    "not set",
    "boolean",
    "integer",
    "double",
    "string",
    "byte array",
    "boolean array",
    "integer array",
    "double array",
    "string array",
)
"""In the order of rcl_interfaces/msg/ParameterType."""

LABELS = (
    "Parameter not set.",
    "Boolean value is:",
    "Integer value is:",
    "Double value is:",
    "String value is:",
    "Byte values are:",
    "Boolean values are:",
    "Integer values are:",
    "Double values are:",
    "String values are:",
)

_FIELDS = tuple(f"{name.replace(' ', '_').replace('boolean', 'bool')}_value" for name in TYPE_NAMES)
_SCALARS: tuple[tuple[type, int], ...] = ((bool, 1), (int, 2), (float, 3), (str, 4))
_INTEGERS = range(-(2**63), 2**63)
NOT_SET = 0
_ARRAY_OFFSET = 5


def content_of(value: Any) -> Any:
    """Return the value in a rcl_interfaces/msg/ParameterValue, None if it is not set."""
    return None if value.type == NOT_SET else getattr(value, _FIELDS[value.type])


def read_value(value: Any) -> Any:
    """Return the value in a ParameterValue as a plain value, arrays as lists."""
    content = content_of(value)
    return list(content) if value.type >= _ARRAY_OFFSET else content


def write_value(value: Any, text: str) -> None:
    """Write a word of the command line to a ParameterValue.

    As with ros2, the word is read as YAML, which gives the type; a word that fits no other type is
    a string. A list of integers and floats becomes a double array.
    """
    try:
        content = load_yaml(text)
    # An invalid date such as the 30th of February is a string.
    except YamlError:
        content = text
    if not set_value(value, content):
        set_value(value, text)


def set_value(value: Any, content: Any) -> bool:
    """Write a Python value to a ParameterValue; return whether a parameter can have its type."""
    if isinstance(content, list):
        return _set_list(value, content)
    for class_, number in _SCALARS:
        if _type_of(content) is class_:
            value.type = number
            setattr(value, _FIELDS[number], content)
            return True
    return False


def _set_list(value: Any, content: list[Any]) -> bool:
    kinds = {_type_of(item) for item in content}
    if kinds == {int, float}:
        content, kinds = [float(item) for item in content], {float}
    for class_, number in _SCALARS:
        if kinds <= {class_}:
            value.type = number + _ARRAY_OFFSET
            setattr(value, _FIELDS[value.type], content)
            return True
    return False


def _type_of(content: Any) -> type | None:
    """Return a value's type, or None for an integer that does not fit into a message."""
    return None if type(content) is int and content not in _INTEGERS else type(content)


class NodeParameters:
    """Calls one node's parameter services. Every method may raise UnansweredError."""

    def __init__(
        self,
        session: CommandSession,
        node: NodeName,
        answer_timeout_s: float | None = ANSWER_TIMEOUT_S,
        server_timeout_s: float = SERVER_TIMEOUT_S,
    ) -> None:
        """Call the services of a node, from a session's node; see `call_service`."""
        self._session = session
        self._node = node
        self._server_timeout_s = server_timeout_s
        self._answer_timeout_s = answer_timeout_s

    def names(self, prefixes: Sequence[str] = ()) -> list[str]:
        """Return the names of its parameters, sorted."""
        request = ListParameters.Request(prefixes=list(prefixes))
        return sorted(self._call(ListParameters, "list_parameters", request).result.names)

    def values(self, names: Sequence[str]) -> list[ParameterValue]:
        """Return the values of parameters in their order; undeclared parameters are missing."""
        request = GetParameters.Request(names=list(names))
        return list(self._call(GetParameters, "get_parameters", request).values)

    def value(self, name: str) -> ParameterValue:
        """Return the value of one parameter.

        Raises:
            NoSuchNameError: the node has no such parameter; the message suggests similar names.
        """
        values = self.values([name])
        if values and values[0].type:
            return values[0]
        self.check_known(name)
        return values[0] if values else ParameterValue()

    def descriptors(self, names: Sequence[str]) -> list[ParameterDescriptor]:
        """Return the descriptors of parameters."""
        request = DescribeParameters.Request(names=list(names))
        return list(self._call(DescribeParameters, "describe_parameters", request).descriptors)

    def set(self, values: Mapping[str, ParameterValue]) -> list[Any]:
        """Set parameters one by one; return a SetParametersResult for each."""
        parameters = [Parameter(name=name, value=value) for name, value in values.items()]
        request = SetParameters.Request(parameters=parameters)
        return list(self._call(SetParameters, "set_parameters", request).results)

    def check_known(self, *names: str) -> None:
        """Check that the node has parameters.

        Raises:
            NoSuchNameError: it lacks a parameter; the message suggests similar names.
        """
        known = self.names()
        for name in names:
            if name not in known:
                hint = describe_known(name, known, "it has")
                raise NoSuchNameError(f"{self._node.full_name} has no parameter {name!r}; {hint}")

    def _call(self, service_class: Any, service: str, request: Any) -> Any:
        name = f"{self._node.full_name}/{service}"
        return call_service(
            self._session,
            service_class,
            name,
            request,
            self._server_timeout_s,
            self._answer_timeout_s,
        )
