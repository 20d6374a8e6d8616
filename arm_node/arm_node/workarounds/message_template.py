"""A message that is serialised once; later, stamps and float64 values are written into the bytes.

It is for messages that are published in every control cycle. To set the lists of an rclpy message
and serialise it costs more than the rest of the cycle. Names and lengths never change, so every
number stays at its place in the bytes, and a new value is a write of eight bytes. Works around
https://github.com/ros2/rclpy/issues/836; made for rclpy 7.1 and 9.1.

The places follow from the encoding, see `cdr_layout`, and are tried out before they are used. A
message in another encoding is set and serialised by rclpy, as is every message if the workaround is
off.
"""

import logging
from collections.abc import Callable, Iterable
from typing import Any

import numpy as np
from builtin_interfaces.msg import Time
from numpy.typing import NDArray
from rclpy.publisher import Publisher
from rclpy.serialization import deserialize_message, serialize_message

from arm_node.workarounds.cdr_layout import HEADER_BYTES, LITTLE_ENDIAN, CdrLayout
from arm_node.workarounds.message_fields import (
    Field,
    Message,
    MessageLayoutError,
    float64_fields,
    float64_fields_at,
    time_fields,
    time_fields_at,
)
from arm_node.workarounds.switch import is_on

_SECONDS_END = 2**31

logger = logging.getLogger(__name__)


def raw_sender(publisher: Publisher) -> Callable[[bytes], None]:
    """Return a function that publishes serialised messages, for one thread at a time.

    rclpy's own `publish` checks the type of each message, which takes several calls. The publisher
    is not destroyed while the function runs.
    """
    return publisher.handle.publish_raw if is_on("message_template") else publisher.publish


def serialized(message: Message) -> bytes:
    """Return a message's bytes without those that rclpy leaves behind its end."""
    data, layout = serialize_message(message), CdrLayout(message)
    return data[: layout.end] if layout.is_known and data.startswith(LITTLE_ENDIAN) else data


class MessageTemplate:
    """A message with fixed names and lengths, and writable stamps and float64 values.

    One thread at a time. Other numbers keep the values of the prototype.

    Attributes:
        to_bytes: returns the message with its current values, serialised.

        template = MessageTemplate(JointState(name=names, position=[0.0] * len(names)))
        position = template.doubles("position")    # a view: write into it
        template.set_stamps(now_ns)
        template.publish(publisher)
    """

    def __init__(self, prototype: Message) -> None:
        """Serialise the prototype and find its numbers.

        Args:
            prototype: has its final strings and the final length of every sequence. It is copied;
                later changes to it have no effect.
        """
        self._layout = _layout_of(prototype)
        self.to_bytes: Callable[[], bytes] = self._layout.to_bytes
        self._message = self._layout.message
        stamps = [field for field in time_fields(self._message) if isinstance(field.owner, Time)]
        places = self._indices(stamps).tolist()
        self._stamps = tuple(zip(places[0::2], places[1::2], strict=True))
        # Setting an item of a memoryview takes a tenth of the time of an array's.
        self._signed = self._layout.int32.data
        self._unsigned = self._layout.int32.view(np.uint32).data

    @property
    def int32(self) -> NDArray[np.int32]:
        """All times and durations, among other words; write only at indices from `time_indices`."""
        return self._layout.int32

    @property
    def float64(self) -> NDArray[np.float64]:
        """All float64 values, among other words; write only at indices from `indices`."""
        return self._layout.float64

    def indices(self, path: str) -> NDArray[np.intp]:
        """Return the indices in `float64` of a field's values, in the message's order.

        Args:
            path: field names separated by dots. The last one is a float64, a sequence or array of
                float64, or a message that contains only these. `[2]` selects one element of a
                sequence of messages, and `[*]` all: "position", "interface_values[*].values",
                "transforms[*].transform".

        Raises:
            MessageLayoutError: there is no such field, or it is not float64.
        """
        return self._indices(float64_fields_at(self._message, path))

    def time_indices(self, path: str) -> NDArray[np.intp]:
        """Return the indices in `int32` of the seconds and nanoseconds of a Time or Duration.

        The path has field names as for `indices`: "points[0].time_from_start".

        Raises:
            MessageLayoutError: there is no such field, or it is neither a time nor a duration.
        """
        return self._indices(time_fields_at(self._message, path))

    def doubles(self, path: str) -> NDArray[np.float64]:
        """Return a writable view, shape (n,), of a field whose values are contiguous.

        Raises:
            MessageLayoutError: as for `indices`, or the values are not contiguous.
        """
        where = self.indices(path)
        if where.size == 0:
            return self.float64[:0]
        if where[-1] - where[0] != where.size - 1 or np.any(np.diff(where) != 1):
            raise MessageLayoutError(
                f"the values of '{path}' of {type(self._message).__name__} are not contiguous; "
                "use indices()"
            )
        return self.float64[where[0] : where[-1] + 1]

    def set_stamps(self, nanoseconds: int) -> None:
        """Set every builtin_interfaces/Time of the message.

        Raises:
            OverflowError: a stamp cannot hold the time, which is before 1901 or after 2038.
        """
        seconds, rest = divmod(nanoseconds, 1_000_000_000)
        if not -_SECONDS_END <= seconds < _SECONDS_END:
            raise OverflowError(f"{seconds} s do not fit into a stamp's 32 bits")
        for second, nanosecond in self._stamps:
            self._signed[second] = seconds
            self._unsigned[nanosecond] = rest

    def publish(self, publisher: Publisher) -> None:
        """Publish the message with its current values.

        Raises:
            RCLError: the publisher has been destroyed.
        """
        self._layout.publish(publisher)

    def _indices(self, fields: Iterable[Field]) -> NDArray[np.intp]:
        places = self._layout.places
        return np.concatenate([np.empty(0, np.intp), *(places[field.key] for field in fields)])


class _SerializedLayout:
    """Numbers in the bytes of a serialised message.

    Attributes:
        message: a copy of the prototype.
        places: indices of each field's numbers in `float64` or `int32`.
    """

    def __init__(self, prototype: Message) -> None:
        """Serialise the message and find its numbers.

        Raises:
            MessageLayoutError: the numbers cannot be found.
        """
        data = serialized(prototype)
        self.message = deserialize_message(data, type(prototype))
        # The body starts at a multiple of 8, so that all its views are aligned.
        storage = np.zeros(8 + 8 * -(-(len(data) - HEADER_BYTES) // 8), dtype=np.uint8)
        self._payload = storage[8 - HEADER_BYTES :][: len(data)]
        self.float64 = storage[8:].view(np.float64)
        self.int32 = storage[8:].view(np.int32)
        layout = CdrLayout(self.message)
        if not layout.is_known or not data.startswith(LITTLE_ENDIAN):
            raise MessageLayoutError(f"a {type(prototype).__name__} is not in the known encoding")
        self.places = {
            field.key: (layout.begins[field.key] - HEADER_BYTES) // size + np.arange(field.size)
            for fields, size in ((float64_fields, 8), (time_fields, 4))
            for field in fields(self.message)
        }
        self._try_out(data)
        self._payload[:] = np.frombuffer(data, dtype=np.uint8)

    def to_bytes(self) -> bytes:
        return self._payload.tobytes()

    def publish(self, publisher: Publisher) -> None:
        publisher.publish(self._payload.tobytes())

    def _try_out(self, data: bytes) -> None:
        """Raise `MessageLayoutError` unless rclpy writes each number where it is expected."""
        message = deserialize_message(data, type(self.message))
        for fields in (float64_fields, time_fields):
            _count_up(fields(message))
        marked = serialized(message)
        if len(marked) == len(data):
            self._payload[:] = np.frombuffer(marked, dtype=np.uint8)
        for fields, array in ((float64_fields, self.float64), (time_fields, self.int32)):
            where = [self.places[field.key] for field in fields(self.message)]
            found = array[np.concatenate([np.empty(0, np.intp), *where])]
            if not np.array_equal(found, np.arange(1, len(found) + 1)):
                raise MessageLayoutError(
                    f"the numbers of a {type(message).__name__} are not where they should be"
                )


class _PlainLayout:
    """Numbers beside a message that rclpy serialises; the attributes of `_SerializedLayout`."""

    def __init__(self, prototype: Message) -> None:
        self.message = deserialize_message(serialize_message(prototype), type(prototype))
        self._doubles = list(float64_fields(self.message))
        self._times = list(time_fields(self.message))
        doubles = [number for field in self._doubles for number in field.numbers]
        times = [number for field in self._times for number in field.numbers]
        self.float64 = np.array(doubles, dtype=np.float64)
        self.int32 = np.array(times, dtype=np.int64).astype(np.int32)
        self.places = {
            **_split(self._doubles, np.arange(len(doubles))),
            **_split(self._times, np.arange(len(times))),
        }

    def to_bytes(self) -> bytes:
        self._set_numbers()
        return serialized(self.message)

    def publish(self, publisher: Publisher) -> None:
        self._set_numbers()
        publisher.publish(self.message)

    def _set_numbers(self) -> None:
        for fields, numbers in ((self._doubles, self.float64), (self._times, self.int32)):
            for field in fields:
                field.set_numbers(numbers[self.places[field.key]].tolist())


def _layout_of(prototype: Message) -> _SerializedLayout | _PlainLayout:
    if is_on("message_template"):
        try:
            return _SerializedLayout(prototype)
        except MessageLayoutError as error:
            logger.info("workaround message_template is off for a message: %s", error)
    return _PlainLayout(prototype)


def _split(fields: Iterable[Field], where: NDArray[np.intp]) -> dict[tuple[int, str], Any]:
    """Return the elements of `where` that belong to each field; it has the order of the fields."""
    parts: dict[tuple[int, str], Any] = {}
    start = 0
    for field in fields:
        parts[field.key] = where[start : start + field.size]
        start += field.size
    return parts


def _count_up(fields: Iterable[Field]) -> None:
    """Set the fields' numbers to 1, 2 and so on."""
    number = 1
    for field in fields:
        kind = type(field.numbers[0]) if field.size else float
        field.set_numbers([kind(each) for each in range(number, number + field.size)])
        number += field.size
