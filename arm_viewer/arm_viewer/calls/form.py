"""The form of a message: its fields with their values as text, and back.

Numbers are text, because a browser's numbers have 53 bits only. Arrays, and messages that are
nested deeper than a form stays readable, are fields of YAML.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from enum import Enum
from typing import Any

import yaml
from rosidl_parser.definition import AbstractGenericString, BasicType, NamespacedType

from arm_node.limited_yaml import YamlError, load_yaml
from arm_node.messages import MessageValueError
from arm_node.messages.fields import FLOATS, INTEGER_RANGES, slots, type_name
from arm_node.messages.filling import FilledMessage, fill_message
from arm_node.messages.text import to_plain

MAX_DEPTH = 4
MAX_FIELDS = 40
"""A message with more fields than these is one field of YAML."""
TIMES = ("builtin_interfaces/msg/Time", "builtin_interfaces/msg/Duration")
"""Shown in one line: their two numbers are never typed apart."""
_LINE_ENDS = frozenset("\r\x85\u2028\u2029")
_WIDTH = 2**31


class FieldKind(Enum):
    """How a field is typed."""

    FLAG = "flag"
    INTEGER = "integer"
    NUMBER = "number"
    TEXT = "text"
    YAML = "yaml"


@dataclass(frozen=True, slots=True)
class FormField:
    """A field of a form.

    Attributes:
        path: names from the message on, such as "pose.position.x"; "" for a whole message.
        type: the type as a .msg file writes it.
        kind: how it is typed.
        text: its value as typed; a flag is "true" or "false".
        least: smallest value; None without a limit.
        most: largest value; None without a limit.
        about: what it means; "" if nobody says.
        is_fixed: whether it is only shown.
    """

    path: str
    type: str
    kind: FieldKind
    text: str
    least: float | None = None
    most: float | None = None
    about: str = ""
    is_fixed: bool = False


def form_of(message: Any) -> tuple[FormField, ...]:
    """Return the form of a message, with its values."""
    fields = tuple(_fields(message, "", MAX_DEPTH))
    if len(fields) > MAX_FIELDS:
        # The outermost level alone.
        fields = tuple(_fields(message, "", 1))
    return fields


def read_form(message: Any, typed: Mapping[str, str]) -> FilledMessage:
    """Set the fields of a message to what was typed; fields that are left empty keep their values.

    Args:
        message: what is filled.
        typed: texts by path; those of `form_of` give back the message.

    Raises:
        MessageValueError: there is no such field, or a text does not fit; the message names it.
    """
    kinds = {field.path: field.kind for field in form_of(message)}
    values: dict[str, Any] = {}
    for path, text in typed.items():
        if path not in kinds:
            raise MessageValueError(f"no field {path!r} (fields: {', '.join(kinds) or 'none'})")
        if text or kinds[path] is FieldKind.TEXT:
            _put(values, path, value_of(kinds[path], text, path))
    return fill_message(message, values)


def value_of(kind: FieldKind, text: str, name: str) -> Any:
    """Return the value that a text stands for.

    Raises:
        MessageValueError: the text is not YAML, or has more of it than may be read.
    """
    if kind is FieldKind.TEXT:
        return text
    try:
        return load_yaml(text)
    except YamlError as error:
        raise MessageValueError(f"{name}: {error}") from error


def flow(value: Any) -> str:
    """Return a plain value as YAML in one line."""
    for allow_unicode in (True, False):
        text = yaml.safe_dump(
            value,
            default_flow_style=True,
            width=_WIDTH,
            sort_keys=False,
            allow_unicode=allow_unicode,
        )
        # Unescaped, a line end other than a line feed becomes a space when it is read.
        if not _LINE_ENDS & set(text):
            break
    return text.removesuffix("\n").removesuffix("\n...")


def _put(values: dict[str, Any], path: str, value: Any) -> None:
    *outer, last = path.split(".")
    for name in outer:
        values = values.setdefault(name, {})
    values[last] = value


def _fields(message: Any, path: str, depth: int) -> Iterable[FormField]:
    for name, type_ in slots(message).items():
        value = getattr(message, name)
        inner = f"{path}.{name}" if path else name
        is_nested = isinstance(type_, NamespacedType) and type_name(type_) not in TIMES
        if is_nested and depth > 1 and slots(value):
            yield from _fields(value, inner, depth - 1)
        else:
            yield _field(inner, type_, value)


def _field(path: str, type_: Any, value: Any) -> FormField:
    name = type_name(type_)
    if isinstance(type_, AbstractGenericString):
        if "\r" in value or "\n" in value:
            # A line of a form would lose the ends of lines.
            return FormField(path, name, FieldKind.YAML, flow(value))
        return FormField(path, name, FieldKind.TEXT, value)
    if not isinstance(type_, BasicType):
        return FormField(path, name, FieldKind.YAML, flow(to_plain(value)))
    if name == "bool":
        return FormField(path, name, FieldKind.FLAG, "true" if value else "false")
    if name in FLOATS:
        return FormField(path, name, FieldKind.NUMBER, flow(float(value)))
    number = value[0] if isinstance(value, bytes) else int(value)
    least, most = INTEGER_RANGES.get(name, (0, 255))
    return FormField(path, name, FieldKind.INTEGER, str(number), least, most)
