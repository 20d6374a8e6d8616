"""Fills messages from YAML text, with errors that name the field and the expected type.

A number with a fraction in an integer field is truncated, as in ros2, but with a note. `auto` for a
header and `now` for a stamp mean the time at which the message is sent.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from rosidl_parser.definition import (
    AbstractGenericString,
    AbstractNestedType,
    Array,
    BasicType,
    BoundedSequence,
    NamespacedType,
)

from arm_node.limited_yaml import YamlError, load_yaml, load_yaml_documents
from arm_node.messages import MessageValueError
from arm_node.messages.fields import FLOATS, INTEGER_RANGES, message_class, slots, type_name

_TRUTH = {"true": True, "false": False, "1": True, "0": False}
_NUMBER = (int, float, str)


@dataclass(frozen=True, slots=True)
class FilledMessage:
    """A message with its values.

    Attributes:
        message: the message itself.
        notes: a sentence for each value that was changed.
        stamps: the messages and fields that get the time of sending.
    """

    message: Any
    notes: list[str] = field(default_factory=list)
    stamps: list[tuple[Any, str]] = field(default_factory=list)

    def stamp(self, time: Any) -> None:
        """Set every field that requested the time of sending to a builtin_interfaces/Time."""
        for owner, name in self.stamps:
            setattr(owner, name, time)


def read_yaml(text: str, type_: str) -> Any:
    """Return the values in a YAML text; an empty text has none.

    Raises:
        MessageValueError: the text is not YAML, or not a mapping from fields to values.
    """
    values = _loaded(load_yaml, text)
    if values is None:
        return {}
    if not isinstance(values, dict):
        raise MessageValueError(
            f"{_not_a_mapping(type_, text, values)}; is it quoted for the shell?"
        )
    return values


def read_yaml_documents(text: str, type_: str) -> list[dict[str, Any]]:
    """Return the values in each document of a YAML text, without the empty documents.

    `arm topic echo` prints such texts, with `---` after each message.

    Raises:
        MessageValueError: the text is not YAML, or a document is not a mapping.
    """
    documents = [d for d in _loaded(load_yaml_documents, text) if d is not None]
    for number, document in enumerate(documents, start=1):
        if not isinstance(document, dict):
            raise MessageValueError(
                f"message {number}: {_not_a_mapping(type_, document, document)}"
            )
    return documents


def _loaded(load: Callable[[str], Any], text: str) -> Any:
    try:
        return load(text)
    except YamlError as error:
        raise MessageValueError(f"the values are not YAML: {error}") from error


def _not_a_mapping(type_: str, shown: Any, values: Any) -> str:
    return (
        f"the values of a {type_} are written 'field: value', but {shown!r} is a "
        f"{type(values).__name__}"
    )


def fill_message(message: Any, values: dict[str, Any]) -> FilledMessage:
    """Set a message's fields.

    Raises:
        MessageValueError: there is no such field, or a value does not fit.
    """
    filled = FilledMessage(message)
    _Filler(filled).fill(message, values, "")
    return filled


class _Filler:
    def __init__(self, filled: FilledMessage) -> None:
        self._filled = filled

    def fill(self, message: Any, values: Any, path: str) -> None:
        types = slots(message)
        if not isinstance(values, dict):
            raise MessageValueError(
                f"{path}: {values!r} where a message is expected (fields: {', '.join(types)})"
            )
        for name, value in values.items():
            if name not in types:
                raise MessageValueError(_unknown_field(str(name), path, list(types)))
            self._set(message, str(name), types[name], value, f"{path}.{name}" if path else name)

    def _set(self, message: Any, name: str, type_: Any, value: Any, path: str) -> None:
        if value == "now" and type_name(type_) == "builtin_interfaces/msg/Time":
            self._filled.stamps.append((message, name))
        elif value == "auto" and type_name(type_) == "std_msgs/msg/Header":
            self._filled.stamps.append((getattr(message, name), "stamp"))
        elif isinstance(type_, NamespacedType):
            self.fill(getattr(message, name), value, path)
        else:
            setattr(message, name, self._convert(type_, value, path))

    def _convert(self, type_: Any, value: Any, path: str) -> Any:
        if isinstance(type_, AbstractNestedType):
            return self._list(type_, value, path)
        if isinstance(type_, NamespacedType):
            element = message_class(type_)()
            self.fill(element, value, path)
            return element
        if isinstance(type_, AbstractGenericString):
            return _string(type_, value, path)
        return self._basic(type_, value, path)

    def _list(self, type_: AbstractNestedType, value: Any, path: str) -> Any:
        if isinstance(value, str) and type_name(type_.value_type) in ("byte", "uint8", "char"):
            value = list(_encoded(value, path))
        if not isinstance(value, list):
            raise MessageValueError(f"{path}: {value!r} is not a list ({type_name(type_)})")
        if isinstance(type_, Array) and len(value) != type_.size:
            raise MessageValueError(
                f"{path}: {len(value)} values, but {type_name(type_)} holds {type_.size}"
            )
        if isinstance(type_, BoundedSequence) and len(value) > type_.maximum_size:
            raise MessageValueError(
                f"{path}: {len(value)} values, but {type_name(type_)} holds at most "
                f"{type_.maximum_size}"
            )
        return [
            self._convert(type_.value_type, item, f"{path}[{index}]")
            for index, item in enumerate(value)
        ]

    def _basic(self, type_: BasicType, value: Any, path: str) -> Any:
        name = type_name(type_)
        if name == "bool":
            truth = _TRUTH.get(str(value).lower())
            if truth is None:
                raise MessageValueError(f"{path}: {value!r} is neither true nor false (bool)")
            return truth
        if name in FLOATS:
            return _number(value, name, path)
        number = self._integer(value, name, path)
        return bytes([number]) if name == "byte" else number

    def _integer(self, value: Any, name: str, path: str) -> int:
        number = _number(value, name, path)
        if number != number or number in (float("inf"), float("-inf")):
            raise MessageValueError(f"{path}: {value!r} is not a whole number ({name})")
        # A float has 53 bits, so an int must not be converted to one.
        whole = value if isinstance(value, int) else int(number)
        if not isinstance(value, int) and whole != number:
            self._filled.notes.append(f"{path}: {value} is truncated to {whole} ({name})")
        low, high = INTEGER_RANGES.get(name, (0, 255))
        if not low <= whole <= high:
            raise MessageValueError(f"{path}: {whole} does not fit {name} ({low} to {high})")
        return int(whole)


def _number(value: Any, name: str, path: str) -> float:
    # YAML 1.1 reads a number without a decimal point, such as 1e-3, as text.
    if isinstance(value, _NUMBER) and not isinstance(value, bool):
        try:
            return float(value)
        except (ValueError, OverflowError):
            pass
    raise MessageValueError(f"{path}: {value!r} is not a number ({name})")


def _string(type_: AbstractGenericString, value: Any, path: str) -> str:
    if isinstance(value, (dict, list)):
        raise MessageValueError(f"{path}: {value!r} is not a text ({type_name(type_)})")
    text = "" if value is None else str(value)
    _encoded(text, path)
    if type_.has_maximum_size() and len(text) > type_.maximum_size:  # pyright: ignore[reportAttributeAccessIssue]
        raise MessageValueError(
            f"{path}: {len(text)} characters, but {type_name(type_)} holds {type_.maximum_size}"  # pyright: ignore[reportAttributeAccessIssue]
        )
    return text


def _encoded(text: str, path: str) -> bytes:
    try:
        return text.encode()
    except UnicodeEncodeError as error:
        raise MessageValueError(
            f"{path}: {text[error.start]!r} at character {error.start + 1} is not valid in UTF-8"
        ) from error


def _unknown_field(name: str, path: str, known: list[str]) -> str:
    import difflib

    near = difflib.get_close_matches(name, known, n=1)
    guess = f"; did you mean {near[0]!r}?" if near else ""
    where = f" in {path}" if path else ""
    return f"no field {name!r}{where}{guess} (fields: {', '.join(known) or 'none'})"
