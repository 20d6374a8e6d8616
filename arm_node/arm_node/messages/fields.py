"""The fields of messages, and their types as a .msg file writes them."""

from importlib import import_module
from typing import Any

from rosidl_parser.definition import (
    AbstractNestedType,
    AbstractString,
    AbstractWString,
    Array,
    BasicType,
    BoundedSequence,
    NamespacedType,
)

INTEGER_RANGES = {
    f"{prefix}int{bits}": (low, high)
    for bits in (8, 16, 32, 64)
    for prefix, low, high in (
        ("", -(2 ** (bits - 1)), 2 ** (bits - 1) - 1),
        ("u", 0, 2**bits - 1),
    )
}
FLOATS = ("float32", "float64")

_MSG_NAMES = {"boolean": "bool", "float": "float32", "double": "float64", "octet": "byte"}


def slots(message: Any) -> dict[str, Any]:
    """Return the fields of a message or message class, each with its type, in order."""
    return dict(zip(message.get_fields_and_field_types(), message.SLOT_TYPES, strict=True))


def type_name(slot_type: Any) -> str:
    """Return a type as a .msg file writes it: float64[4], geometry_msgs/msg/Point, string."""
    if isinstance(slot_type, BasicType):
        return _MSG_NAMES.get(slot_type.typename, slot_type.typename)
    if isinstance(slot_type, NamespacedType):
        return "/".join(slot_type.namespaced_name())
    if isinstance(slot_type, AbstractNestedType):
        return f"{type_name(slot_type.value_type)}[{_size(slot_type)}]"
    if isinstance(slot_type, AbstractString):
        return "string"
    return "wstring" if isinstance(slot_type, AbstractWString) else str(slot_type)


def abbreviation(slot_type: AbstractNestedType, length: int) -> str:
    """Return the placeholder for an array that is not printed, as in ros2."""
    value_type = slot_type.value_type
    name = value_type.typename if isinstance(value_type, BasicType) else type_name(value_type)
    if isinstance(slot_type, Array):
        return f"<array type: {name}[{slot_type.size}]>"
    if isinstance(slot_type, BoundedSequence):
        return f"<sequence type: {name}[{slot_type.maximum_size}], length: {length}>"
    return f"<sequence type: {name}, length: {length}>"


def message_class(slot_type: NamespacedType) -> type:
    """Return the class of a nested message."""
    module = import_module(".".join(slot_type.namespaces))
    return getattr(module, slot_type.name)


def _size(slot_type: AbstractNestedType) -> str:
    if isinstance(slot_type, Array):
        return str(slot_type.size)
    if isinstance(slot_type, BoundedSequence):
        return f"<={slot_type.maximum_size}"
    return ""
