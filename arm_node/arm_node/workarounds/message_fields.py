"""Finds the numbers of a message by their names: float64 values, times and durations."""

import re
from collections.abc import Iterable, Iterator, Sequence
from typing import Any

from builtin_interfaces.msg import Duration, Time

from arm_node.frozen import frozen

Message = Any
"""An instance of a generated message class; these have no common base class."""

_STEP = re.compile(r"(\w+)(?:\[(\*|\d+)\])?")
_FLOAT64 = re.compile(r"(?:sequence<double(?:, \d+)?>|double\[\d+\])")


class MessageLayoutError(Exception):
    """The numbers of a message cannot be found in its bytes, or a path names no such number."""


@frozen
class Field:
    """A field of a message: one number, or `count` numbers in a sequence."""

    owner: Message
    name: str
    count: int | None = None

    @property
    def key(self) -> tuple[int, str]:
        """Identifies the field during the lifetime of its message."""
        return id(self.owner), self.name

    @property
    def size(self) -> int:
        """How many numbers the field has."""
        return 1 if self.count is None else self.count

    @property
    def numbers(self) -> list[Any]:
        """The field's numbers, in order."""
        value = getattr(self.owner, self.name)
        return [value] if self.count is None else list(value)

    def set_numbers(self, numbers: list[Any]) -> None:
        """Set all numbers of the field."""
        setattr(self.owner, self.name, numbers[0] if self.count is None else numbers)


def float64_fields(message: Message) -> Iterator[Field]:
    """Yield every float64 field of a message, at any depth, in the message's order."""
    for name, kind in message.get_fields_and_field_types().items():
        if _is_float64(kind):
            yield _float64_field(message, name, kind)
        elif "/" in kind:
            for inner in _messages(getattr(message, name)):
                yield from float64_fields(inner)


def time_fields(message: Message) -> Iterator[Field]:
    """Yield seconds and nanoseconds of every Time and Duration, in the message's order."""
    if isinstance(message, Time | Duration):
        yield from _parts_of_time(message)
        return
    for name, kind in message.get_fields_and_field_types().items():
        if "/" in kind:
            for inner in _messages(getattr(message, name)):
                yield from time_fields(inner)


def float64_fields_at(message: Message, path: str) -> Iterator[Field]:
    """Yield the float64 fields at a path; see `MessageTemplate.indices`.

    Raises:
        MessageLayoutError: there is no such field, or it is not float64.
    """
    *steps, last = path.split(".")
    for owner in _walk(message, steps):
        yield from _numbers_at(owner, last)


def time_fields_at(message: Message, path: str) -> Iterator[Field]:
    """Yield seconds and nanoseconds of the times and durations at a path.

    Raises:
        MessageLayoutError: there is no such field, or it is neither a time nor a duration.
    """
    for time in _walk(message, path.split(".")):
        if not isinstance(time, Time | Duration):
            raise MessageLayoutError(
                f"'{path}' is {type(time).__name__}, neither time nor duration"
            )
        yield from _parts_of_time(time)


def _is_float64(kind: str) -> bool:
    return kind == "double" or _FLOAT64.fullmatch(kind) is not None


def _float64_field(owner: Message, name: str, kind: str) -> Field:
    return Field(owner, name, None if kind == "double" else len(getattr(owner, name)))


def _parts_of_time(time: Time | Duration) -> tuple[Field, Field]:
    return Field(time, "sec"), Field(time, "nanosec")


def _messages(value: Message | Sequence[Message]) -> Sequence[Message]:
    """Return the messages in a field, which has one message or a sequence of them."""
    return [value] if hasattr(value, "get_fields_and_field_types") else value


def _walk(message: Message, steps: Iterable[str]) -> list[Message]:
    owners = [message]
    for step in steps:
        owners = [inner for owner in owners for inner in _messages_at(owner, step)]
    return owners


def _messages_at(owner: Message, step: str) -> list[Message]:
    match = _STEP.fullmatch(step)
    kinds = owner.get_fields_and_field_types()
    if match is None or match.group(1) not in kinds:
        raise MessageLayoutError(
            f"{type(owner).__name__} has no field '{step}'; it has {', '.join(kinds)}"
        )
    value = getattr(owner, match.group(1))
    subscript = match.group(2)
    if "/" not in kinds[match.group(1)]:
        raise MessageLayoutError(f"'{step}' of {type(owner).__name__} is not a message")
    if hasattr(value, "get_fields_and_field_types") != (subscript is None):
        raise MessageLayoutError(
            f"'{step}' of {type(owner).__name__} is {kinds[match.group(1)]}; "
            "a sequence takes [*] or an index, and a single message takes neither"
        )
    if subscript is None:
        return [value]
    if subscript == "*":
        return list(value)
    if int(subscript) >= len(value):
        raise MessageLayoutError(f"'{step}' is out of range: the sequence has length {len(value)}")
    return [value[int(subscript)]]


def _numbers_at(owner: Message, step: str) -> Iterator[Field]:
    kind = owner.get_fields_and_field_types().get(step, "")
    if _is_float64(kind):
        yield _float64_field(owner, step, kind)
    else:
        for message in _messages_at(owner, step):
            for name in message.get_fields_and_field_types():
                yield from _numbers_at(message, name)
