"""A message serialised once, whose stamps and float64 values are then written in place.

For what is published at every tick. Setting the lists of a rclpy message and serialising it costs
more than the rest of a tick; names and lengths never change, so neither do the places of the
numbers in the serialised bytes, and writing eight bytes is all that a new value needs.

The places are found by serialising: every number gets a mark of its own, twice with different
marks, and each mark must stand in exactly one aligned word both times. No rule of the encoding
is assumed, so an encoding that does not keep numbers in aligned words is refused, not damaged.
No marks come again: padding holds whatever lay in memory, and that may be a message marked before.
"""

import itertools
import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from builtin_interfaces.msg import Duration, Time
from numpy.typing import NDArray
from rclpy.publisher import Publisher
from rclpy.serialization import deserialize_message, serialize_message

from arm_node.raw_publisher import RawPublisher

Message = Any
"""A generated message class's instance: they share no typed base."""

HEADER_BYTES = 4
"""The encoding's own header; alignment counts from its end."""

_STEP = re.compile(r"(\w+)(?:\[(\*|\d+)\])?")
_FLOAT64 = re.compile(r"(?:sequence<double(?:, \d+)?>|double\[\d+\])")
# Marks: tag << 32 | number, as float64 small ordinary numbers; tag << 20 | number, positive int32.
_TAGS_64 = itertools.cycle(range(0x3FA00000, 0x3FB00000))
_TAGS_32 = itertools.cycle(range(0x100, 0x800))
_PASSES = 2
_SECONDS_END = 2**31


class MessageLayoutError(Exception):
    """The bytes of a message do not show where its numbers are, or it has no such numbers."""


@dataclass(frozen=True, slots=True)
class _Field:
    """A field of a message: one number, or `count` numbers in a sequence."""

    owner: Message
    name: str
    count: int | None = None


class MessageTemplate:
    """A message of fixed names and lengths with writable stamps and float64 values.

    One thread at a time. Numbers other than times and float64 stay as in the prototype.

        template = MessageTemplate(JointState(name=names, position=[0.0] * len(names)))
        position = template.doubles("position")    # a view: write into it
        template.set_stamps(now_ns)
        template.publish(publisher)
    """

    def __init__(self, prototype: Message) -> None:
        """Serialise a message.

        Args:
            prototype: has its final strings and the final length of every sequence. It is read
                here only; later changes to it mean nothing.

        Raises:
            MessageLayoutError: the stamps cannot be found in the serialised bytes.
        """
        self._type = type(prototype)
        self._serialized = serialize_message(prototype)
        self._size = len(self._serialized)
        words = -(-(self._size - HEADER_BYTES) // 8)
        # The body starts at a multiple of 8, so that every view of it is aligned.
        self._storage = np.zeros(8 + 8 * words, dtype=np.uint8)
        start = 8 - HEADER_BYTES
        self._payload = self._storage[start : start + self._size]
        self._payload[:] = np.frombuffer(self._serialized, dtype=np.uint8)
        self._float64 = self._storage[8:].view(np.float64)
        self._int32 = self._storage[8:].view(np.int32)
        stamps = self._locate(_stamp_fields, np.dtype(np.uint32), _TAGS_32, 20).tolist()
        self._stamps = tuple(zip(stamps[0::2], stamps[1::2], strict=True))
        # An item of a memoryview is set in a tenth of the time of an array's.
        self._signed = self._int32.data
        self._unsigned = self._storage[8:].view(np.uint32).data

    @property
    def int32(self) -> NDArray[np.int32]:
        """The whole body as int32 words; write only at what `time_indices` returns."""
        return self._int32

    @property
    def float64(self) -> NDArray[np.float64]:
        """The whole body as float64 words; write only at what `indices` returns."""
        return self._float64

    def indices(self, path: str) -> NDArray[np.intp]:
        """Return where in `float64` the values of a field are, in the message's order.

        Args:
            path: fields parted by dots: a float64, a sequence or array of them, or a message of
                nothing else; `[2]` takes one element of a sequence of messages, `[*]` all:
                "position", "interface_values[*].values", "transforms[*].transform".

        Raises:
            MessageLayoutError: no such field, not float64, or not to be found in the bytes.
        """
        return self._locate(
            lambda message: _float64_fields(message, path), np.dtype(np.uint64), _TAGS_64, 32
        )

    def time_indices(self, path: str) -> NDArray[np.intp]:
        """Return where in `int32` the seconds and the nanoseconds of a Time or Duration are.

        Args:
            path: fields parted by dots, as for `indices`: "points[0].time_from_start".

        Raises:
            MessageLayoutError: no such field, or not to be found in the bytes.
        """
        return self._locate(
            lambda message: _time_fields(message, path), np.dtype(np.uint32), _TAGS_32, 20
        )

    def doubles(self, path: str) -> NDArray[np.float64]:
        """Return a writable view (n,) of a field whose values stand side by side.

        Raises:
            MessageLayoutError: as `indices`, or the values do not stand side by side.
        """
        where = self.indices(path)
        if where.size == 0:
            return self._float64[:0]
        if where[-1] - where[0] != where.size - 1 or np.any(np.diff(where) != 1):
            raise MessageLayoutError(
                f"'{path}' of {self._type.__name__} stands in several places; use indices()"
            )
        return self._float64[where[0] : where[-1] + 1]

    def set_stamps(self, nanoseconds: int) -> None:
        """Set every builtin_interfaces/Time of the message.

        Raises:
            OverflowError: a time that the message cannot hold, before 1901 or after 2038.
        """
        seconds, rest = divmod(nanoseconds, 1_000_000_000)
        if not -_SECONDS_END <= seconds < _SECONDS_END:
            raise OverflowError(f"{seconds} s do not fit into a stamp's 32 bits")
        for second, nanosecond in self._stamps:
            self._signed[second] = seconds
            self._unsigned[nanosecond] = rest

    def to_bytes(self) -> bytes:
        """Return the message as it stands, serialised."""
        return self._payload.tobytes()

    def publish(self, publisher: Publisher) -> None:
        """Publish the message as it stands.

        Raises:
            RCLError: the publisher is destroyed already.
        """
        RawPublisher(publisher).publish(self._payload.tobytes())

    def _locate(
        self,
        find_fields: Callable[[Message], Iterator[_Field]],
        word: np.dtype[Any],
        tags: Iterator[int],
        shift: int,
    ) -> NDArray[np.intp]:
        found: NDArray[np.bool_] | None = None
        count = 0
        marked = np.empty(0, dtype=word)
        for tag in itertools.islice(tags, _PASSES):
            message = deserialize_message(self._serialized, self._type)
            count = _mark(find_fields(message), word, tag << shift)
            marked = self._words(serialize_message(message), word)
            here = marked >> shift == tag
            # Text and lengths may look like a mark, but not like both.
            found = here if found is None else found & here
        where = np.flatnonzero(found) if found is not None else np.empty(0, dtype=np.intp)
        numbers = marked[where] & word.type((1 << shift) - 1)
        if not np.array_equal(np.sort(numbers), np.arange(count)):
            raise MessageLayoutError(
                f"cannot find the {count} marked numbers of {self._type.__name__} in its bytes"
            )
        return where[np.argsort(numbers)]

    def _words(self, serialized: bytes, word: np.dtype[Any]) -> NDArray[Any]:
        if len(serialized) != self._size:
            raise MessageLayoutError(
                f"{self._type.__name__} takes {self._size} bytes, then {len(serialized)}"
            )
        count = (self._size - HEADER_BYTES) // word.itemsize
        return np.frombuffer(serialized, dtype=word, offset=HEADER_BYTES, count=count)


def _mark(fields: Iterator[_Field], word: np.dtype[Any], first: int) -> int:
    """Give the fields' numbers the marks `first`, `first` + 1 and so on; return how many."""
    number = 0
    for field in fields:
        size = 1 if field.count is None else field.count
        marks = np.arange(first + number, first + number + size, dtype=word)
        values = marks.view(np.float64).tolist() if word.itemsize == 8 else marks.tolist()
        setattr(field.owner, field.name, values[0] if field.count is None else values)
        number += size
    return number


def _stamp_fields(message: Message) -> Iterator[_Field]:
    if isinstance(message, Time):
        yield from (_Field(message, "sec"), _Field(message, "nanosec"))
        return
    for name, kind in message.get_fields_and_field_types().items():
        if "/" in kind:
            for inner in _messages(getattr(message, name)):
                yield from _stamp_fields(inner)


def _messages(value: Message | Sequence[Message]) -> Sequence[Message]:
    """Return the one message, or those of the sequence, that a field of messages holds."""
    return [value] if hasattr(value, "get_fields_and_field_types") else value


def _float64_fields(message: Message, path: str) -> Iterator[_Field]:
    *steps, last = path.split(".")
    for owner in _walk(message, steps):
        yield from _numbers_at(owner, last)


def _time_fields(message: Message, path: str) -> Iterator[_Field]:
    for time in _walk(message, path.split(".")):
        if not isinstance(time, Time | Duration):
            raise MessageLayoutError(
                f"'{path}' is {type(time).__name__}, neither time nor duration"
            )
        yield from (_Field(time, "sec"), _Field(time, "nanosec"))


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
        raise MessageLayoutError(f"'{step}' of {type(owner).__name__} is no message")
    if hasattr(value, "get_fields_and_field_types") != (subscript is None):
        raise MessageLayoutError(
            f"'{step}' of {type(owner).__name__} is {kinds[match.group(1)]}; "
            "[*] or an index goes with a sequence, and with nothing else"
        )
    if subscript is None:
        return [value]
    if subscript == "*":
        return list(value)
    if int(subscript) >= len(value):
        raise MessageLayoutError(f"'{step}' is outside the sequence, which has {len(value)}")
    return [value[int(subscript)]]


def _numbers_at(owner: Message, step: str) -> Iterator[_Field]:
    kind = owner.get_fields_and_field_types().get(step, "")
    if kind == "double":
        yield _Field(owner, step)
    elif _FLOAT64.fullmatch(kind):
        yield _Field(owner, step, len(getattr(owner, step)))
    else:
        for message in _messages_at(owner, step):
            for name in message.get_fields_and_field_types():
                yield from _numbers_at(message, name)
