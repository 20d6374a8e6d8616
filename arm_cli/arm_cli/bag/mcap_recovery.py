"""Reconstructs the missing summary of an MCAP file from its readable records.

A recorder that was killed leaves complete chunks and no index. After a power failure the last chunk
may be torn.
"""

import io
import struct
import zlib
from collections import defaultdict
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import BinaryIO

from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Channel, Chunk, ChunkIndex, Message, Schema, Statistics
from mcap.stream_reader import MAGIC_SIZE, breakup_chunk
from mcap.summary import Summary

from arm_cli.bag.chunk_sizes import MAX_CHUNK_BYTES, ChunkTooLargeError, check_chunk

_HEADER = struct.Struct("<BQ")

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


@dataclass(frozen=True, slots=True)
class _Record:
    offset: int
    opcode: int
    content: bytes

    def stream(self) -> ReadDataStream:
        return ReadDataStream(io.BytesIO(self.content))


def damage_errors() -> tuple[type[Exception], ...]:
    """Return the exceptions that reading a damaged file may raise."""
    import zstandard

    return (*_DAMAGE, zstandard.ZstdError)


def recover_summary(stream: BinaryIO) -> Summary:
    """Return the summary of all records before the first damage."""
    summary = Summary()
    counter = _Counter(summary)
    damage = damage_errors()
    for record in _records(stream):
        try:
            counter.add(record)
        except ChunkTooLargeError:
            raise
        except damage:
            break
    summary.statistics = counter.statistics()
    return summary


def _records(stream: BinaryIO) -> Iterator[_Record]:
    end = stream.seek(0, io.SEEK_END)
    offset = MAGIC_SIZE
    while offset + _HEADER.size <= end:
        stream.seek(offset)
        opcode, length = _HEADER.unpack(stream.read(_HEADER.size))
        following = offset + _HEADER.size + length
        if following > end or opcode == Opcode.DATA_END:
            return
        if length > MAX_CHUNK_BYTES:
            raise ChunkTooLargeError(f"a record has {length} bytes; the limit is {MAX_CHUNK_BYTES}")
        wanted = opcode in _Counter.WANTED
        yield _Record(offset, opcode, stream.read(length) if wanted else b"")
        offset = following


class _Counter:
    """Adds records to a summary and counts the messages."""

    WANTED = frozenset((Opcode.CHUNK, Opcode.SCHEMA, Opcode.CHANNEL, Opcode.MESSAGE))

    def __init__(self, summary: Summary) -> None:
        self._summary = summary
        self._counts: dict[int, int] = defaultdict(int)
        self._first_ns: int | None = None
        self._last_ns = 0

    def add(self, record: _Record) -> None:
        read: dict[int, Callable[[], object]] = {
            Opcode.SCHEMA: lambda: self._add_plain(Schema.read(record.stream())),
            Opcode.CHANNEL: lambda: self._add_plain(Channel.read(record.stream())),
            Opcode.MESSAGE: lambda: self._add_plain(
                Message.read(record.stream(), len(record.content))
            ),
            Opcode.CHUNK: lambda: self._add_chunk(record),
        }
        if record.opcode in read:
            read[record.opcode]()

    def _add_chunk(self, record: _Record) -> None:
        chunk = Chunk.read(record.stream())
        check_chunk(chunk)
        for inner in breakup_chunk(chunk, validate_crc=True):
            self._add_plain(inner)
        self._summary.chunk_indexes.append(
            ChunkIndex(
                chunk_length=_HEADER.size + len(record.content),
                chunk_start_offset=record.offset,
                compression=chunk.compression,
                compressed_size=len(chunk.data),
                message_end_time=chunk.message_end_time,
                message_index_length=0,
                message_index_offsets={},
                message_start_time=chunk.message_start_time,
                uncompressed_size=chunk.uncompressed_size,
            )
        )

    def _add_plain(self, record: object) -> None:
        if isinstance(record, Schema):
            self._summary.schemas[record.id] = record
        elif isinstance(record, Channel):
            self._summary.channels[record.id] = record
        elif isinstance(record, Message):
            time_ns = record.log_time
            self._counts[record.channel_id] += 1
            self._first_ns = time_ns if self._first_ns is None else min(self._first_ns, time_ns)
            self._last_ns = max(self._last_ns, time_ns)

    def statistics(self) -> Statistics:
        return Statistics(
            attachment_count=0,
            channel_count=len(self._summary.channels),
            channel_message_counts=dict(self._counts),
            chunk_count=len(self._summary.chunk_indexes),
            message_count=sum(self._counts.values()),
            metadata_count=0,
            message_start_time=self._first_ns or 0,
            message_end_time=self._last_ns,
            schema_count=len(self._summary.schemas),
        )
