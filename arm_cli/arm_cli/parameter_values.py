"""Parameter values as text, and text as parameter values."""

from typing import Any

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
    """Return what a rcl_interfaces/msg/ParameterValue holds, None where it holds nothing."""
    return None if value.type == NOT_SET else getattr(value, _FIELDS[value.type])


def read_value(value: Any) -> Any:
    """Return what a ParameterValue holds as a plain value, arrays as lists."""
    content = content_of(value)
    return list(content) if value.type >= _ARRAY_OFFSET else content


def write_value(value: Any, text: str) -> None:
    """Put a word of the command line into a ParameterValue.

    As with ros2, the word is read as YAML, which tells the type; what fits no type is a string. A
    list that mixes whole and other numbers is one of doubles.
    """
    import yaml

    try:
        content = yaml.safe_load(text)
    # PyYAML's constructors raise a ValueError: the 30th of February is no date, but a word.
    except (yaml.YAMLError, ValueError):
        content = text
    if not set_value(value, content):
        set_value(value, text)


def set_value(value: Any, content: Any) -> bool:
    """Put a Python value into a ParameterValue; return whether it is of a type that fits."""
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
    """Return a value's type; None for an integer that is too large for a message."""
    return None if type(content) is int and content not in _INTEGERS else type(content)
