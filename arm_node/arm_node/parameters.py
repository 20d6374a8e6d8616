"""Declares parameters of one fixed type, which readers then convert; see `parameter_values`.

A given value may have another notation than the type: `2` for a double, `[1, 0]` or the text
`[1, 0.5]` for a list of doubles, a text of words for a list of texts. It is converted when the
parameter is declared. A client that sets the parameter later must give the type, as in ROS 2.
"""

from array import array
from collections.abc import Callable, Mapping
from typing import Any

from rcl_interfaces.msg import (
    FloatingPointRange,
    IntegerRange,
    ParameterDescriptor,
    SetParametersResult,
)
from rclpy.node import Node
from rclpy.parameter import Parameter

from arm_node.parameter_values import (
    ParameterValueError,
    Reader,
    Value,
    is_number,
    numbers_in,
    range_of,
    read_parameter,
    refusal,
    wanted_by,
)
from arm_node.setting import Setting

Type = Parameter.Type

_ELEMENTS = {
    Type.BOOL_ARRAY: bool,
    Type.INTEGER_ARRAY: int,
    Type.DOUBLE_ARRAY: float,
    Type.STRING_ARRAY: str,
}
_SCALARS = {Type.BOOL: bool, Type.INTEGER: int, Type.DOUBLE: float, Type.STRING: str}
_MAX_INT = 2**63 - 1


def declare(
    node: Node,
    name: str,
    default: object,
    read: Reader[Value],
    description: str,
    *,
    read_only: bool = True,
    given: Mapping[str, object] | None = None,
) -> Value:
    """Declare a parameter and return its value, converted by `read`.

    Args:
        node: declares the parameter.
        name: of the parameter.
        default: its value if none is given; it also has the parameter's type. An empty list stands
            for texts, an empty `array("d")` for numbers.
        read: converts the value; a reader of texts returns them.
        description: one line for `arm param describe`.
        read_only: whether it is fixed once the node runs.
        given: the given values by parameter name; by default those of the node.

    Raises:
        ParameterValueError: `read` refuses the given value; the message names the parameter.
    """
    kind, wanted = type_of(default), wanted_by(read)
    own = (given_parameters(node) if given is None else given).get(name, default)
    value = read_parameter(name, own, read)
    stored = _stored(value, own, kind)
    if not _has_type(stored, kind):
        raise ParameterValueError(f"{name} {refusal(wanted, own)}")
    declare_typed(
        node, name, kind, stored, description, wanted, read_only=read_only, bounds=range_of(read)
    )
    return value


def declare_setting(node: Node, each: Setting, given: Mapping[str, object] | None = None) -> Any:
    """Declare the parameter of a setting and return its value; see `declare`."""
    return declare(
        node,
        each.name,
        each.default,
        each.read,
        each.about,
        read_only=not each.changes,
        given=given,
    )


def declare_typed(
    node: Node,
    name: str,
    kind: Type,
    value: Any,
    description: str,
    constraints: str = "",
    *,
    read_only: bool = False,
    bounds: tuple[float, float] | None = None,
) -> None:
    """Declare a parameter of a type, whatever else is given for it; the value has that type.

    The constraints are in words, the bounds the smallest and the largest value of a number.
    """
    descriptor = ParameterDescriptor(
        description=description, additional_constraints=constraints, read_only=read_only
    )
    if bounds is not None:
        _set_range(descriptor, kind, *bounds)
    if kind not in _ELEMENTS:
        node.declare_parameter(name, value, descriptor, ignore_override=True)
        return
    # rclpy cannot infer the type of an empty list, so declare the type, then set the value, then
    # the descriptor, which may be read-only.
    node.declare_parameter(name, kind, ignore_override=True)
    node.set_parameters([Parameter(name, kind, list(value))])
    descriptor.type = kind.value
    node.set_descriptor(name, descriptor)


def given_parameters(node: Node) -> dict[str, Any]:
    """Return a node's parameters from files and arguments; None for an empty list."""
    # rclpy offers no other access to values that are not yet declared.
    overrides = node._parameter_overrides  # pyright: ignore[reportPrivateUsage]
    return {name: given.value for name, given in overrides.items()}


def check_changes(
    node: Node, check: Callable[[list[Parameter]], object], *refusals: type[Exception]
) -> None:
    """Have a function check what clients set; its errors refuse it, and are the reason."""

    def answer(changed: list[Parameter]) -> SetParametersResult:
        try:
            check(changed)
        except refusals as error:
            return SetParametersResult(successful=False, reason=str(error))
        return SetParametersResult(successful=True)

    node.add_on_set_parameters_callback(answer)


def take_other_notations(node: Node, name: str) -> None:
    """Let clients set a list in another notation: an empty one, or one of integers for doubles.

    An empty list has no type of its own on a command line, and ROS has no list of integers and
    doubles. The parameter's type stays as it is declared.
    """

    def convert(changed: list[Parameter]) -> list[Parameter]:
        return [in_its_type(node, item) if item.name == name else item for item in changed]

    node.add_pre_set_parameters_callback(convert)


def in_its_type(node: Node, given: Parameter) -> Parameter:
    """Return a list in the type of the node's parameter; unchanged if it cannot have that type."""
    if not node.has_parameter(given.name):
        return given
    kind = Type(node.describe_parameter(given.name).type)
    value: Any = _doubles(given.value) if kind is Type.DOUBLE_ARRAY else given.value
    if kind in _ELEMENTS and _has_type(value, kind):
        return Parameter(given.name, kind, list(value))
    return given


def type_of(default: Any, element: type | None = None) -> Type:
    """Return the type of a parameter with this default; see `declare`.

    `element` is the type of a list's elements, if it is known.
    """
    if element is not None:
        return next(kind for kind, each in _ELEMENTS.items() if each is element)
    if isinstance(default, array):
        return Type.DOUBLE_ARRAY
    if isinstance(default, list | tuple) and not default:
        return Type.STRING_ARRAY
    return Type.from_parameter_value(default)


def _set_range(descriptor: ParameterDescriptor, kind: Type, low: float, high: float) -> None:
    """Give the descriptor of a number its smallest and largest value."""
    if kind is Type.INTEGER:
        low, high = (int(min(max(bound, -_MAX_INT), _MAX_INT)) for bound in (low, high))
        descriptor.integer_range = [IntegerRange(from_value=low, to_value=high)]
    elif kind is Type.DOUBLE:
        bounds = FloatingPointRange(from_value=float(low), to_value=float(high))
        descriptor.floating_point_range = [bounds]


def _stored(value: object, given: object, kind: Type) -> Any:
    """Return a given value in the parameter's type, if it can have it."""
    if kind is Type.DOUBLE and is_number(given):
        return float(given)
    if kind is Type.DOUBLE_ARRAY:
        return _doubles([] if given in (None, "") else given)
    if kind is Type.STRING_ARRAY and isinstance(value, tuple | list):
        return list(value)
    return given


def _doubles(given: object) -> Any:
    numbers = numbers_in(given)
    if isinstance(numbers, list | tuple | array) and all(map(is_number, numbers)):
        return [float(number) for number in numbers]
    return given


def _has_type(value: Any, kind: Type) -> bool:
    if kind in _SCALARS:
        return type(value) is _SCALARS[kind]
    element = _ELEMENTS.get(kind)
    return isinstance(value, list | tuple | array) and all(type(item) is element for item in value)
