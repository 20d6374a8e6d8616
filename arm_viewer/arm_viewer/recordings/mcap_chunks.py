"""The chunks of an MCAP file: which of them hold a topic's messages, and their unpacked bytes."""

import io
import struct
import zlib
from collections import OrderedDict
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

import numpy as np
from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.reader import SeekingReader
from mcap.records import Channel, Chunk, ChunkIndex
from mcap.stream_reader import get_chunk_data_stream
from mcap.summary import Summary
from numpy.typing import NDArray

from arm_node.user_file import open_file
from arm_viewer.errors import PageRecordingError

MAX_CHUNK_BYTES = 200_000_000
KEPT_BYTES = 64_000_000
"""Unpacked chunks that are kept; the newest is kept whatever its size."""
KEPT_INDEXES = 512
RECORD_HEADER = struct.Struct("<BQ")
"""Opcode and length of every record."""
MESSAGE_HEADER = struct.Struct("<HIQQ")
"""Channel, sequence number, log time, publish time; the data follow."""
_INDEX_HEADER = struct.Struct("<HI")
_INDEX_BYTES = RECORD_HEADER.size + _INDEX_HEADER.size
_ENTRY_BYTES = 16


@dataclass(frozen=True, slots=True)
class ChunkPlace:
    """A chunk that holds messages of a channel."""

    file: "McapChunks"
    index: ChunkIndex
    channel: int

    @property
    def start_ns(self) -> int:
        """The time of its first message, of any channel."""
        return self.index.message_start_time

    @property
    def end_ns(self) -> int:
        """The time of its last message, of any channel."""
        return self.index.message_end_time

    def entries(self) -> NDArray[np.uint64]:
        """Return times in ns and offsets in the unpacked chunk (n, 2), in the order of time."""
        return self.file.entries(self.index, self.channel)

    def data(self) -> bytes:
        """Return the unpacked chunk."""
        return self.file.unpacked(self.index)


class McapChunks:
    """Reads the chunks of one file; one thread at a time.

    Attributes:
        summary: its channels, schemas and statistics.
    """

    def __init__(self, path: Path) -> None:
        """Open the file and read its index.

        Raises:
            PageRecordingError: it cannot be opened, is damaged, or has no index.
        """
        self.path = path
        try:
            self._stream: BinaryIO = open_file(path)
        except OSError as error:
            raise PageRecordingError(f"cannot read {path}: {error.strerror}") from error
        self._chunks: OrderedDict[int, bytes] = OrderedDict()
        self._entries: OrderedDict[tuple[int, int], NDArray[np.uint64]] = OrderedDict()
        try:
            with self._damage():
                reader = SeekingReader(self._stream, record_size_limit=MAX_CHUNK_BYTES)
                summary = reader.get_summary()
            if summary is None or not _is_indexed(summary):
                raise PageRecordingError(
                    f"{path} has no complete index: it is being recorded, or its recorder was "
                    "killed; `arm bag convert` writes it anew with one"
                )
        except PageRecordingError:
            self.close()
            raise
        self.summary = summary

    def close(self) -> None:
        """Close the file."""
        self._stream.close()

    def places(self, channel: Channel) -> Iterator[ChunkPlace]:
        """Yield the chunks that hold messages of a channel."""
        for index in self.summary.chunk_indexes:
            if channel.id in index.message_index_offsets:
                yield ChunkPlace(self, index, channel.id)

    def entries(self, index: ChunkIndex, channel: int) -> NDArray[np.uint64]:
        """Return times and places of a channel's messages; see `ChunkPlace.entries`."""
        key = (index.chunk_start_offset, channel)
        found = self._entries.get(key)
        if found is None:
            with self._damage():
                found = self._read_entries(index, channel)
            self._entries[key] = found
            if len(self._entries) > KEPT_INDEXES:
                self._entries.popitem(last=False)
        else:
            self._entries.move_to_end(key)
        return found

    def unpacked(self, index: ChunkIndex) -> bytes:
        """Return the records of a chunk as bytes.

        Raises:
            PageRecordingError: the chunk is damaged or too large.
        """
        key = index.chunk_start_offset
        data = self._chunks.get(key)
        if data is None:
            with self._damage():
                data = self._read_chunk(index)
            self._chunks[key] = data
            while len(self._chunks) > 1 and sum(map(len, self._chunks.values())) > KEPT_BYTES:
                self._chunks.popitem(last=False)
        else:
            self._chunks.move_to_end(key)
        return data

    def _read_entries(self, index: ChunkIndex, channel: int) -> NDArray[np.uint64]:
        self._stream.seek(index.message_index_offsets[channel] + RECORD_HEADER.size)
        found, size = _INDEX_HEADER.unpack(self._stream.read(_INDEX_HEADER.size))
        if found != channel or size % _ENTRY_BYTES or size > index.message_index_length:
            raise McapError(f"there is no index of channel {channel} where the summary has one")
        entries = np.frombuffer(self._stream.read(size), dtype="<u8").reshape(-1, 2)
        if np.any(entries[1:, 0] < entries[:-1, 0]):
            entries = entries[np.argsort(entries[:, 0], kind="stable")]
        return entries

    def _read_chunk(self, index: ChunkIndex) -> bytes:
        self._stream.seek(index.chunk_start_offset + RECORD_HEADER.size)
        length = index.chunk_length - RECORD_HEADER.size
        _check_size(max(length, index.uncompressed_size))
        chunk = Chunk.read(ReadDataStream(io.BytesIO(self._stream.read(length))))
        _check_size(max(chunk.uncompressed_size, _frame_size(chunk)))
        stream, size = get_chunk_data_stream(chunk, validate_crc=True)
        return stream.read(size)

    @contextmanager
    def _damage(self) -> Iterator[None]:
        """Turn what a damaged file or an unreadable disk raises into a sentence."""
        import zstandard

        try:
            yield
        except (
            *(McapError, ValueError, LookupError, OverflowError, MemoryError, OSError),
            *(struct.error, RuntimeError, EOFError, zlib.error, zstandard.ZstdError),
        ) as error:
            reason = str(error).splitlines()[0] if str(error) else type(error).__name__
            raise PageRecordingError(f"{self.path} cannot be read: {reason}") from error


def _is_indexed(summary: Summary) -> bool:
    """Return whether the summary leads to every message."""
    statistics, chunks = summary.statistics, summary.chunk_indexes
    if statistics is None or len(chunks) != statistics.chunk_count:
        return False
    used = {channel for chunk in chunks for channel in chunk.message_index_offsets}
    entries = sum(
        (chunk.message_index_length - _INDEX_BYTES * len(chunk.message_index_offsets))
        // _ENTRY_BYTES
        for chunk in chunks
    )
    return used <= summary.channels.keys() and entries == statistics.message_count


def _frame_size(chunk: Chunk) -> int:
    """Return the size that a zstd frame says it unpacks to; 0 if it says none."""
    import zstandard

    if chunk.compression != "zstd":
        return 0
    size = zstandard.get_frame_parameters(chunk.data).content_size
    return 0 if size == zstandard.CONTENTSIZE_UNKNOWN else size


def _check_size(size: int) -> None:
    if size > MAX_CHUNK_BYTES:
        raise McapError(f"a chunk has {size} bytes; the limit is {MAX_CHUNK_BYTES}")
