"""Converts parameter values to text and text to parameter values."""

from typing import Any

from arm_node.limited_yaml import YamlError, load_yaml

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
