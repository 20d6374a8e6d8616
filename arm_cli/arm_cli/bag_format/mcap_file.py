"""Reads one MCAP file, finished or not.

The messages are found by the summary at the file's end, or by reading all its records: the
specification makes every part of the summary optional, and a recorder that was killed leaves none.
After a power failure the last chunk may be torn.
"""

import io
import struct
import zlib
from array import array
from collections import Counter
from collections.abc import Callable, Collection, Iterator
from contextlib import ExitStack
from dataclasses import dataclass, field
from heapq import merge
from pathlib import Path
from typing import Any, BinaryIO

from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.reader import FOOTER_SIZE, SeekingReader
from mcap.records import (
    Channel,
    Chunk,
    ChunkIndex,
    Message,
    Metadata,
    MetadataIndex,
    Schema,
    Statistics,
)
from mcap.stream_reader import MAGIC_SIZE, breakup_chunk
from mcap.summary import Summary
from mcap.writer import MCAP0_MAGIC

from arm_cli.bag_format.chunk_sizes import (
    MAX_CHUNK_BYTES,
    ChunkTooLargeError,
    check_chunk,
    check_chunks,
)
from arm_cli.bag_format.metadata import BagFileInfo, TimeSpan
from arm_cli.bag_format.offered_qos import read_offers
from arm_cli.bag_format.topic import BagMessage, BagTopic, RecordedTopic, TypeDefinition
from arm_cli.bag_format.writer import LIBRARY
from arm_cli.bag_format.yaml_text import load_yaml
from arm_cli.errors import BagError
from arm_node.user_file import open_file

_HEADER = struct.Struct("<BQ")
_MESSAGE = struct.Struct("<HIQQ")
"""Channel, sequence number, log time, publish time; the data follow."""
_FOOTER_START = struct.Struct("<BQQ")
_INDEX_BYTES = 15
"""The size of an empty message index; each message adds 16 bytes."""

_DAMAGE: tuple[type[Exception], ...] = (
    McapError,
    ValueError,
    LookupError,
    OverflowError,
    MemoryError,
    OSError,
    struct.error,
    RuntimeError,
    EOFError,
    zlib.error,
)
"""Exceptions from reading damaged records or an unreadable disk."""


def damage_errors() -> tuple[type[Exception], ...]:
    """Return the exceptions that reading a damaged file may raise."""
    import zstandard

    return (*_DAMAGE, zstandard.ZstdError)


@dataclass(slots=True)
class PlainMessages:
    """The messages outside chunks, in the order of the file: channels, times, places."""

    channels: "array[int]" = field(default_factory=lambda: array("H"))
    log_times_ns: "array[int]" = field(default_factory=lambda: array("Q"))
    offsets: "array[int]" = field(default_factory=lambda: array("Q"))

    def add(self, channel: int, log_time_ns: int, offset: int) -> None:
        """Add the message whose record is at an offset."""
        self.channels.append(channel)
        self.log_times_ns.append(log_time_ns)
        self.offsets.append(offset)

    def in_time_order(self) -> Iterator[int]:
        """Yield the indices of the messages in the order of their log times."""
        times_ns = self.log_times_ns
        return iter(sorted(range(len(times_ns)), key=times_ns.__getitem__))

    def read(self, stream: BinaryIO, index: int) -> Message:
        """Return a message with its data."""
        stream.seek(self.offsets[index])
        _, length = _HEADER.unpack(stream.read(_HEADER.size))
        return Message.read(ReadDataStream(stream), length)


@dataclass(frozen=True, slots=True)
class McapIndex:
    """The contents of a file.

    Attributes:
        summary: schemas, channels, chunks and statistics, all complete.
        plain: the messages outside chunks.
        is_finished: whether the file's writer finished it.
    """

    summary: Summary
    plain: PlainMessages
    is_finished: bool


def read_index(stream: BinaryIO) -> McapIndex:
    """Return the index of a file; reads all records if its summary lacks a part.

    Raises:
        Exception: one of `damage_errors`. An unfinished file has those records that come before
            its first damage.
    """
    finished = _is_finished(stream)
    if finished:
        summary = _reader(stream).get_summary()
        if summary is not None and _is_complete(summary):
            return McapIndex(summary, PlainMessages(), True)
    scan = _Scan()
    scan.run(stream, tolerant=not finished)
    return McapIndex(scan.summary, scan.plain, finished)


def _reader(stream: BinaryIO) -> SeekingReader:
    stream.seek(0)
    return SeekingReader(stream, validate_crcs=True, record_size_limit=MAX_CHUNK_BYTES)


def _is_finished(stream: BinaryIO) -> bool:
    size = stream.seek(0, io.SEEK_END)
    if size < 2 * MAGIC_SIZE + FOOTER_SIZE:
        return False
    stream.seek(size - MAGIC_SIZE)
    if stream.read(MAGIC_SIZE) != MCAP0_MAGIC:
        return False
    stream.seek(size - MAGIC_SIZE - FOOTER_SIZE)
    opcode, _, summary_start = _FOOTER_START.unpack(stream.read(_FOOTER_START.size))
    if opcode == Opcode.FOOTER and summary_start:
        return True
    # The recorder of this suite ends a file without a summary after each flush, and with one when
    # it finishes.
    return _reader(stream).get_header().library != LIBRARY


def _is_complete(summary: Summary) -> bool:
    """Return whether a summary has everything that the reader needs."""
    statistics, chunks = summary.statistics, summary.chunk_indexes
    if statistics is None or len(chunks) != statistics.chunk_count:
        return False
    counts = statistics.channel_message_counts
    if sum(counts.values()) != statistics.message_count:
        return False
    indexed = [chunk for chunk in chunks if chunk.message_index_offsets]
    used = {*counts, *(channel for chunk in indexed for channel in chunk.message_index_offsets)}
    channels = summary.channels
    schemas = {0, *summary.schemas}
    if not (used <= channels.keys() and len(channels) >= statistics.channel_count):
        return False
    if not {channel.schema_id for channel in channels.values()} <= schemas:
        return False
    # Messages may also be outside chunks.
    if len(indexed) < len(chunks):
        return True
    entries = sum(
        (chunk.message_index_length - _INDEX_BYTES * len(chunk.message_index_offsets)) // 16
        for chunk in chunks
    )
    return entries == statistics.message_count


@dataclass(frozen=True, slots=True)
class _Record:
    offset: int
    opcode: int
    length: int
    content: bytes

    def stream(self) -> ReadDataStream:
        return ReadDataStream(io.BytesIO(self.content))


class _Scan:
    """Reads the records of a file and collects what a complete summary has."""

    def __init__(self) -> None:
        self.summary = Summary()
        self.plain = PlainMessages()
        self._counts: Counter[int] = Counter()
        self._first_ns: int | None = None
        self._last_ns = 0
        self._readers: dict[int, Callable[[_Record], None]] = {
            Opcode.SCHEMA: lambda record: self._add(Schema.read(record.stream())),
            Opcode.CHANNEL: lambda record: self._add(Channel.read(record.stream())),
            Opcode.MESSAGE: self._add_plain_message,
            Opcode.CHUNK: self._add_chunk,
            Opcode.METADATA: self._add_metadata,
        }

    def run(self, stream: BinaryIO, tolerant: bool) -> None:
        """Read the records, up to the first damage if that is tolerated."""
        damage = damage_errors()
        for record in self._records(stream, tolerant):
            try:
                self._readers[record.opcode](record)
            except ChunkTooLargeError:
                raise
            except damage:
                if not tolerant:
                    raise
                break
        self.summary.statistics = self._statistics()

    def _records(self, stream: BinaryIO, tolerant: bool) -> Iterator[_Record]:
        """Yield the records that a summary repeats, with only the beginning of a message."""
        end = stream.seek(0, io.SEEK_END)
        offset = MAGIC_SIZE
        while offset + _HEADER.size <= end:
            stream.seek(offset)
            opcode, length = _HEADER.unpack(stream.read(_HEADER.size))
            following = offset + _HEADER.size + length
            if opcode == Opcode.DATA_END:
                return
            if following > end:
                break
            if opcode in self._readers:
                if length > MAX_CHUNK_BYTES:
                    raise ChunkTooLargeError(
                        f"a record has {length} bytes; the limit is {MAX_CHUNK_BYTES}"
                    )
                read = min(length, _MESSAGE.size) if opcode == Opcode.MESSAGE else length
                yield _Record(offset, opcode, _HEADER.size + length, stream.read(read))
            offset = following
        if not tolerant:
            raise McapError(f"the record at offset {offset} does not end within the file")

    def _add_chunk(self, record: _Record) -> None:
        chunk = Chunk.read(record.stream())
        check_chunk(chunk)
        inner = breakup_chunk(chunk, validate_crc=True)
        for one in inner:
            self._add(one)
        times_ns = [one.log_time for one in inner if isinstance(one, Message)]
        self.summary.chunk_indexes.append(
            ChunkIndex(
                chunk_length=record.length,
                chunk_start_offset=record.offset,
                compression=chunk.compression,
                compressed_size=len(chunk.data),
                message_end_time=max(times_ns, default=0),
                message_index_length=0,
                message_index_offsets={},
                message_start_time=min(times_ns, default=0),
                uncompressed_size=chunk.uncompressed_size,
            )
        )

    def _add_metadata(self, record: _Record) -> None:
        name = Metadata.read(record.stream()).name
        self.summary.metadata_indexes.append(MetadataIndex(record.offset, record.length, name))

    def _add(self, record: object) -> None:
        if isinstance(record, Schema):
            self.summary.schemas[record.id] = record
        elif isinstance(record, Channel):
            self.summary.channels[record.id] = record
        elif isinstance(record, Message):
            self._count(record.channel_id, record.log_time)

    def _add_plain_message(self, record: _Record) -> None:
        channel, _, log_time_ns, _ = _MESSAGE.unpack(record.content)
        self._count(channel, log_time_ns)
        self.plain.add(channel, log_time_ns, record.offset)

    def _count(self, channel: int, time_ns: int) -> None:
        if channel not in self.summary.channels:
            raise McapError(f"a message belongs to channel {channel}, which is not described")
        self._counts[channel] += 1
        self._first_ns = time_ns if self._first_ns is None else min(self._first_ns, time_ns)
        self._last_ns = max(self._last_ns, time_ns)

    def _statistics(self) -> Statistics:
        return Statistics(
            attachment_count=0,
            channel_count=len(self.summary.channels),
            channel_message_counts=dict(self._counts),
            chunk_count=len(self.summary.chunk_indexes),
            message_count=self._counts.total(),
            metadata_count=len(self.summary.metadata_indexes),
            message_start_time=self._first_ns or 0,
            message_end_time=self._last_ns,
            schema_count=len(self.summary.schemas),
        )


class _ChunkReader(SeekingReader):
    """Reads the messages in the chunks of a summary."""

    def __init__(self, stream: BinaryIO, summary: Summary) -> None:
        stream.seek(0)
        super().__init__(stream, validate_crcs=True)
        self._given = summary

    def get_summary(self) -> Summary:
        return self._given


class McapFileReader:
    """Reads one file.

    Attributes:
        path: the path of the file.
        is_finished: whether its writer finished it.
        info: its name, and the time span and number of its messages.
        topics: its topics; one of several types, definitions or formats is there for each.
    """

    def __init__(self, path: Path) -> None:
        """Open the file, and scan it if its summary lacks a part.

        Raises:
            BagError: the file cannot be opened, or is damaged.
        """
        self.path = path
        try:
            self._stream = open_file(path)
        except OSError as error:
            raise BagError(f"cannot read {path}: {error.strerror}") from error
        with ExitStack() as opening:
            opening.callback(self._stream.close)
            if self._stream.read(MAGIC_SIZE) != MCAP0_MAGIC:
                raise BagError(f"{path} is not an MCAP file")
            try:
                index = read_index(self._stream)
                check_chunks(self._stream, index.summary.chunk_indexes)
                self.topics = _topics(index.summary)
            except damage_errors() as error:
                raise self._damaged(error) from error
            opening.pop_all()
        self._summary, self._plain = index.summary, index.plain
        self._reader = _ChunkReader(self._stream, index.summary)
        self.is_finished = index.is_finished
        self.info = BagFileInfo(path.name, *_extent(self._summary.statistics))

    def close(self) -> None:
        """Close the file."""
        self._stream.close()

    def embedded_metadata(self) -> dict[str, Any]:
        """Return what rosbag2 writes of metadata.yaml into the file; empty if there is nothing."""
        try:
            for record in self._reader.iter_metadata():
                if record.name == "rosbag2":
                    plain = load_yaml(record.metadata.get("serialized_metadata", ""))
                    return plain if isinstance(plain, dict) else {}
        except damage_errors():
            pass
        return {}

    def messages(self, topics: Collection[str], start_ns: int) -> Iterator[BagMessage]:
        """Yield the messages of some topics from a time on, in the order of their time.

        Raises:
            BagError: the file is damaged.
        """
        wanted = set(topics)
        expected = sum(one.count for one in self.topics if one.topic.name in wanted)
        found = 0
        try:
            for channel, message in self._found(wanted, start_ns):
                yield BagMessage(
                    channel.topic, message.log_time, message.publish_time, message.data
                )
                found += 1
        except damage_errors() as error:
            raise self._damaged(error) from error
        if start_ns <= (self.info.span.start_ns or 0) and found != expected:
            raise BagError(
                f"{self.path} is damaged: it counts {expected} messages of these topics, and its "
                f"index leads to {found}"
            )

    def _found(self, topics: Collection[str], start_ns: int) -> Iterator[tuple[Channel, Message]]:
        """Yield the messages in and outside chunks in the order of their time."""
        sources: list[Iterator[tuple[Channel, Message]]] = []
        if self._summary.chunk_indexes:
            chunked = self._reader.iter_messages(topics, starting_at=start_ns)
            sources.append((channel, message) for _, channel, message in chunked)
        sources.append(self._found_plain(topics, start_ns))
        return merge(*sources, key=lambda one: one[1].log_time)

    def _found_plain(
        self, topics: Collection[str], start_ns: int
    ) -> Iterator[tuple[Channel, Message]]:
        plain, channels = self._plain, self._summary.channels
        for index in plain.in_time_order():
            channel = channels[plain.channels[index]]
            if channel.topic in topics and plain.log_times_ns[index] >= start_ns:
                yield channel, plain.read(self._stream, index)

    def _damaged(self, error: Exception) -> BagError:
        reason = str(error).splitlines()[0] if str(error) else type(error).__name__
        return BagError(f"{self.path} is damaged: {reason}")


def _topics(summary: Summary) -> list[RecordedTopic]:
    counts = summary.statistics.channel_message_counts if summary.statistics else {}
    return [
        _topic(channel, summary, counts.get(channel.id, 0)) for channel in summary.channels.values()
    ]


def _topic(channel: Channel, summary: Summary, count: int) -> RecordedTopic:
    schema = summary.schemas.get(channel.schema_id)
    if schema is None and channel.schema_id:
        raise LookupError(f"{channel.topic} has the schema {channel.schema_id}, which is missing")
    definition = (
        TypeDefinition("", b"")
        if schema is None
        else TypeDefinition(schema.name, schema.data, schema.encoding)
    )
    topic = BagTopic(
        name=channel.topic,
        type=definition.name,
        type_hash=channel.metadata.get("topic_type_hash", ""),
        offers=read_offers(channel.metadata.get("offered_qos_profiles", "")),
        serialization_format=channel.message_encoding,
    )
    return RecordedTopic(topic, definition, count)


def _extent(statistics: Statistics | None) -> tuple[TimeSpan, int]:
    if statistics is None or statistics.message_count == 0:
        return TimeSpan(), 0
    span = TimeSpan(statistics.message_start_time, statistics.message_end_time)
    return span, statistics.message_count
