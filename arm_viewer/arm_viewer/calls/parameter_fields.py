"""Parameters as fields of a form: ranges from their descriptors, and typed values."""

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any

from arm_node.messages import MessageValueError
from arm_viewer.calls.form import FieldKind, FormField, flow, value_of

VALUE_FIELDS = (
    *("", "bool_value", "integer_value", "double_value", "string_value", "byte_array_value"),
    *("bool_array_value", "integer_array_value", "double_array_value", "string_array_value"),
)
"""The field of rcl_interfaces/msg/ParameterValue, by rcl_interfaces/msg/ParameterType."""
TYPE_NAMES = (
    *("not set", "bool", "integer", "double", "string", "byte[]"),
    *("bool[]", "integer[]", "double[]", "string[]"),
)
_KINDS = (FieldKind.YAML, FieldKind.FLAG, FieldKind.INTEGER, FieldKind.NUMBER, FieldKind.TEXT)
_STRING, _FIRST_ARRAY = 4, 5
_SCALARS: Mapping[type, int] = MappingProxyType({bool: 1, int: 2, float: 3, str: 4})
_INTEGERS = range(-(2**63), 2**63)


def parameter_field(descriptor: Any, value: Any) -> FormField:
    """Return the field of a parameter, from its ParameterDescriptor and its ParameterValue."""
    kind = value.type or descriptor.type
    content: Any = getattr(value, VALUE_FIELDS[value.type]) if value.type else None
    if value.type >= _FIRST_ARRAY:
        content = [item[0] if isinstance(item, bytes) else item for item in content]
    ranges = [*descriptor.integer_range, *descriptor.floating_point_range]
    field_kind = _KINDS[kind] if kind < _FIRST_ARRAY else FieldKind.YAML
    shown = content if field_kind is FieldKind.TEXT else flow(content)
    text = "" if content is None else shown
    hints = [descriptor.description, descriptor.additional_constraints]
    return FormField(
        path=descriptor.name,
        type=TYPE_NAMES[kind],
        kind=field_kind,
        text=text,
        least=ranges[0].from_value if ranges else None,
        most=ranges[0].to_value if ranges else None,
        about="; ".join(filter(None, hints)),
        is_fixed=descriptor.read_only,
    )


def parameter_value(kind: int, text: str, name: str) -> tuple[int, Any]:
    """Return the type and the content that a typed text stands for.

    Args:
        kind: the parameter's rcl_interfaces/msg/ParameterType; 0 takes the type from the text.
        text: what was typed.
        name: the parameter's name.

    Raises:
        MessageValueError: the text does not fit the type; the message names the parameter.
    """
    content = text if kind == _STRING else value_of(FieldKind.YAML, text, name)
    kind = kind or _type_of(content)
    if not 0 < kind < len(VALUE_FIELDS):
        raise MessageValueError(f"{name}: {text!r} cannot be the value of a parameter")
    convert = _CONVERTERS[kind if kind < _FIRST_ARRAY else kind - _FIRST_ARRAY]
    try:
        if kind < _FIRST_ARRAY:
            return kind, convert(content)
        if not isinstance(content, list):
            raise TypeError
        return kind, [convert(item) for item in content]
    except (TypeError, ValueError, OverflowError):
        wanted = TYPE_NAMES[kind]
        raise MessageValueError(f"{name}: {text!r} is not a value of the type {wanted}") from None


def _type_of(content: Any) -> int:
    if isinstance(content, list):
        kinds = {_type_of(item) for item in content}
        if kinds == {2, 3}:
            return 3 + _FIRST_ARRAY
        return kinds.pop() + _FIRST_ARRAY if len(kinds) == 1 and kinds <= {1, 2, 3, 4} else 0
    return _SCALARS.get(type(content), 0)


def _flag(content: Any) -> bool:
    if not isinstance(content, bool):
        raise TypeError
    return content


def _integer(content: Any) -> int:
    if isinstance(content, bool) or not isinstance(content, int) or content not in _INTEGERS:
        raise TypeError
    return content


def _number(content: Any) -> float:
    # YAML 1.1 reads 1e-3 as text.
    if isinstance(content, bool) or not isinstance(content, int | float | str):
        raise TypeError
    return float(content)


def _text(content: Any) -> str:
    if not isinstance(content, str):
        raise TypeError
    return content


def _byte(content: Any) -> bytes:
    return bytes([_integer(content)])


_CONVERTERS: tuple[Callable[[Any], Any], ...] = (_byte, _flag, _integer, _number, _text)
