"""The file of a recorded run: an MCAP file that is readable to its last second after a kill.

It holds the header with all that rebuilds the run, then, as they come, inputs and blocks of states
with one hash for each control period. Files of format 1, whose values are JSON, are read as well.
"""

import base64
import dataclasses
import json
import struct
import zlib
from collections import deque
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass
from enum import Enum
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
import zstandard
from mcap.exceptions import McapError
from mcap.records import Channel, Message
from mcap.stream_reader import StreamReader
from mcap.writer import Writer
from numpy.typing import NDArray

from arm_control.errors import StateError
from arm_control.state.class_names import class_named
from arm_control.state.encoding import decode, encode
from arm_gazebo.errors import RecordingError

FORMATS = (1, 2)
"""Those that this version reads; it writes the last. In format 1 a value is JSON."""
PROFILE = "arm-run"
LIBRARY = "arm-suite"
HEADER, INPUT, STATES, END = "header", "input", "states", "end"
MAX_BLOCK_BYTES = 1 << 30
"""No block that a recorder writes is larger; a file that says so is damaged."""

_BLOCK = struct.Struct("<QIII")
"""First period, number of periods, interval of the stored states, values of a state."""


@dataclass(frozen=True, slots=True)
class RecordedInput:
    """An input and when it took effect.

    Attributes:
        period: the control period before which it took effect, counted from 0.
        robot: index of the robot whose manager or controller took it; None for the simulation.
        controller: name of the controller; None for the manager or the simulation.
        method: name of the method.
        arguments: its arguments by name.
        raised: whether it was refused: it ended with an exception.
    """

    period: int
    robot: int | None
    controller: str | None
    method: str
    arguments: Mapping[str, Any]
    raised: bool = False


@dataclass(frozen=True, slots=True)
class StateBlock:
    """The states after consecutive control periods.

    Attributes:
        first: number of the first period.
        hashes: a running hash after each period, uint64, shape (n,).
        interval: every how many periods a state is stored; the first period of the block has one.
        states: the stored states, shape (ceil(n / interval), width).
    """

    first: int
    hashes: NDArray[np.uint64]
    interval: int
    states: NDArray[np.float64]

    def state(self, period: int) -> NDArray[np.float64] | None:
        """Return the state after a period, or None if it is not stored."""
        index, rest = divmod(period - self.first, self.interval)
        return None if rest or not 0 <= index < len(self.states) else self.states[index]


@dataclass(frozen=True, slots=True)
class RecordingEnd:
    """The end of a recording that was finished.

    Attributes:
        periods: number of recorded periods.
        reason: why it ended; "" if it was stopped by its user.
    """

    periods: int
    reason: str = ""


Record = RecordedInput | StateBlock | RecordingEnd


@dataclass(frozen=True, slots=True)
class RecordedPeriod:
    """A recorded control period with the inputs that took effect before it."""

    number: int
    block: StateBlock
    inputs: tuple[RecordedInput, ...]

    @property
    def hash(self) -> int:
        """The running hash after the period."""
        return int(self.block.hashes[self.number - self.block.first])


class RunFileWriter:
    """Writes a recording to a new file; not thread-safe. Each `flush` leaves a readable file.

    The header is what rebuilds the run: plain data.

    Raises:
        RecordingError: the file exists, or cannot be written.
    """

    def __init__(self, path: Path, header: Mapping[str, Any]) -> None:
        self.path = path
        try:
            # The writer below owns the file; it is closed in `close`.
            self._stream: BinaryIO = path.open("xb")
        except FileExistsError as error:
            raise RecordingError(f"{path} exists already; choose another name") from error
        except OSError as error:
            raise RecordingError(f"cannot write {path}: {error.strerror}") from error
        try:
            self._begin(header)
        except OSError as error:
            self.close()
            path.unlink(missing_ok=True)
            raise RecordingError(f"cannot write {path}: {error.strerror}") from error

    def _begin(self, header: Mapping[str, Any]) -> None:
        self._writer = Writer(self._stream, use_chunking=False, enable_data_crcs=False)
        self._writer.start(PROFILE, LIBRARY)
        schema = self._writer.register_schema("", "", b"")
        self._channels = {
            topic: self._writer.register_channel(topic, "", schema)
            for topic in (HEADER, INPUT, STATES, END)
        }
        self._message(HEADER, 0, _bytes_of({"format": FORMATS[-1], **header}))
        self.flush()

    def write(self, record: Record) -> None:
        """Append a record.

        Raises:
            OSError: the file cannot be written.
            NotPlainError: an argument of an input is not plain data.
        """
        match record:
            case RecordedInput():
                self._message(INPUT, record.period, _bytes_of(record))
            case StateBlock():
                self._message(STATES, record.first, _block_bytes(record))
            case RecordingEnd():
                self._message(END, record.periods, _bytes_of(record))

    def flush(self) -> None:
        """Hand everything so far to the operating system."""
        self._writer.flush()
        self._stream.flush()

    def close(self) -> None:
        """Finish the file; it stays readable if that fails."""
        with suppress(OSError):
            self._writer.finish()
        with suppress(OSError):
            self._stream.close()

    def _message(self, topic: str, sequence: int, data: bytes) -> None:
        channel = self._channels[topic]
        self._writer.add_message(channel, sequence, data, sequence, sequence & 0xFFFFFFFF)


class RunFile:
    """Reads a recording, record by record.

    Raises:
        RecordingError: it does not exist, or is not a recording.

    Attributes:
        header: what rebuilds the run.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.header: Mapping[str, Any] = self._read_header()

    def records(self) -> Iterator[Record]:
        """Return the records in order; a file that was cut off ends early, without an end record.

        Raises:
            RecordingError: the file is damaged before its end.
        """
        with self._open() as stream:
            for topic, data in _raw_records(stream):
                if topic != HEADER:
                    yield self._record(topic, data)

    def periods(self) -> Iterator[RecordedPeriod | RecordingEnd]:
        """Return the control periods in order, and the end if there is one; see `records`."""
        waiting: deque[RecordedInput] = deque()
        for record in self.records():
            match record:
                case RecordedInput():
                    waiting.append(record)
                case RecordingEnd():
                    yield record
                case StateBlock():
                    for number in range(record.first, record.first + len(record.hashes)):
                        inputs: list[RecordedInput] = []
                        while waiting and waiting[0].period <= number:
                            inputs.append(waiting.popleft())
                        yield RecordedPeriod(number, record, tuple(inputs))

    def count_periods(self) -> int:
        """Return the number of recorded control periods; it reads the whole file.

        Raises:
            RecordingError: the file is damaged before its end.
        """
        return sum(len(item.hashes) for item in self.records() if isinstance(item, StateBlock))

    def _open(self) -> BinaryIO:
        try:
            if not self.path.is_file():
                state = "is not a file" if self.path.exists() else "does not exist"
                raise RecordingError(f"{self.path} {state}")
            return self.path.open("rb")
        except OSError as error:
            raise RecordingError(f"cannot read {self.path}: {error.strerror}") from error

    def _read_header(self) -> Mapping[str, Any]:
        with self._open() as stream:
            topic, data = next(_raw_records(stream), ("", b""))
        if topic != HEADER:
            raise RecordingError(f"{self.path} is not a recording of a run")
        header = self._value(data)
        if not isinstance(header, dict):
            raise RecordingError(f"{self.path} is damaged: its header is not a mapping")
        if header.get("format") not in FORMATS:
            raise RecordingError(
                f"{self.path} has format {header.get('format')}; this version reads "
                f"{' and '.join(map(str, FORMATS))}"
            )
        return header

    def _record(self, topic: str, data: bytes) -> Record:
        try:
            if topic in (INPUT, END):
                return self._value(data)
            return _block(data)
        except (ValueError, struct.error) as error:
            raise RecordingError(f"{self.path} is damaged: {error}") from error

    def _value(self, data: bytes) -> Any:
        try:
            content = _decompressed(data)
            return read_json(content) if content.startswith(b"{") else decode(content)
        except (StateError, ValueError, RecursionError) as error:
            raise RecordingError(f"{self.path} is damaged: {error}") from error


def _raw_records(stream: BinaryIO) -> Iterator[tuple[str, bytes]]:
    """Return topic and content of each message up to where the file ends."""
    topics: dict[int, str] = {}
    # Where the file is cut off, the library finds a record that ends too early, or none at all.
    with suppress(McapError, EOFError, struct.error, zlib.error, UnicodeDecodeError):
        for record in StreamReader(stream, record_size_limit=MAX_BLOCK_BYTES).records:
            match record:
                case Channel():
                    topics[record.id] = record.topic
                case Message():
                    yield topics.get(record.channel_id, ""), record.data
                case _:
                    pass


def _bytes_of(value: object) -> bytes:
    return zstandard.compress(encode(value), 3)


def _decompressed(data: bytes) -> bytes:
    try:
        return zstandard.decompress(data, MAX_BLOCK_BYTES)
    except (zstandard.ZstdError, MemoryError) as error:
        # A damaged frame may claim any size.
        raise ValueError(str(error) or "a part does not fit into memory") from error


def _block_bytes(block: StateBlock) -> bytes:
    head = _BLOCK.pack(block.first, len(block.hashes), block.interval, block.states.shape[1])
    hashes, states = block.hashes, np.ascontiguousarray(block.states)
    # Without a copy of megabytes, and without Python's lock, which the simulation needs.
    parts = zstandard.ZstdCompressor(1).compressobj(hashes.nbytes + states.nbytes)
    return b"".join((head, parts.compress(hashes.data), parts.compress(states.data), parts.flush()))


def _block(data: bytes) -> StateBlock:
    first, count, interval, width = _BLOCK.unpack_from(data)
    content = _decompressed(data[_BLOCK.size :])
    if interval < 1 or len(content) != 8 * (count + width * -(-count // interval)):
        raise ValueError("a block of states has the wrong size")
    hashes = np.frombuffer(content, np.uint64, count)
    states = np.frombuffer(content, np.float64, offset=8 * count).reshape(-1, width)
    return StateBlock(first, hashes, interval, states)


def read_json(content: bytes) -> Any:
    """Return the value of a record.

    Raises:
        ValueError: it names a class that does not exist, or is damaged.
    """
    try:
        return _value(json.loads(content))
    except (KeyError, TypeError, AttributeError, ImportError) as error:
        raise ValueError(f"{type(error).__name__}: {error}") from error


def _value(data: Any) -> Any:
    match data:
        case [*items]:
            return tuple(map(_value, items))
        case {"!list": items}:
            return [_value(item) for item in items]
        case {"!set": items}:
            return {_value(item) for item in items}
        case {"!dict": pairs}:
            return {_value(key): _value(item) for key, item in pairs}
        case {"!bytes": text}:
            return base64.b64decode(text)
        case {"!array": text, "dtype": dtype, "shape": shape}:
            array = np.frombuffer(base64.b64decode(text), dtype=np.dtype(dtype))
            return array.reshape(shape).copy()
        case {"!enum": name, "name": member}:
            return _class(name, Enum)[member]
        case {"!data": name, **fields}:
            values = {key: _value(item) for key, item in fields.items()}
            return _class(name, None)(**values)
        case dict():
            return {key: _value(item) for key, item in data.items()}
        case _:
            return data


def _class(name: str, base: type | None) -> Any:
    """Return a dataclass, or a class that derives from `base`, by its name."""
    found = class_named(name)
    is_fit = isinstance(found, type) and (
        issubclass(found, base) if base is not None else dataclasses.is_dataclass(found)
    )
    if not is_fit:
        raise ValueError(f"there is no class '{name}' here")
    return found
