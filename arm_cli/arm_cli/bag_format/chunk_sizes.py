"""Checks the uncompressed size of an MCAP file's chunks before any is decompressed.

A chunk of 20 kB can decompress to gigabytes, and the size in its index can be wrong.
"""

import struct
from collections.abc import Iterable, Sequence
from typing import BinaryIO

from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Chunk, ChunkIndex

MAX_CHUNK_BYTES = 200_000_000
MAX_OVERLAP_BYTES = 400_000_000
"""Limit for chunks whose times overlap: they are decompressed together to sort their messages."""
COMPRESSIONS = ("", "lz4", "zstd")
_HEADER = struct.Struct("<BQ")
_CHUNK = struct.Struct("<QQQII")
"""Start, end, unpacked size, checksum, length of the compression's name."""
_LENGTH = struct.Struct("<Q")
_LONGEST_NAME = 100
_FRAME_HEADER = 18
"""The size of the longest header of a zstd frame, in bytes."""


class ChunkTooLargeError(McapError):
    """A chunk, or several chunks needed at once, would take too much memory."""


def check_chunks(stream: BinaryIO, indexes: Sequence[ChunkIndex]) -> None:
    """Check that a file's chunks are small enough to be decompressed.

    Raises:
        ChunkTooLargeError: a chunk, or a group of overlapping chunks, is too large.
        McapError: an index points to something that is not a chunk.
    """
    sizes = [_check_at(stream, index.chunk_start_offset) for index in indexes]
    overlap = _largest_overlap(indexes, sizes)
    if overlap > MAX_OVERLAP_BYTES:
        raise ChunkTooLargeError(
            f"chunks of the same time decompress to {overlap} bytes; the limit is "
            f"{MAX_OVERLAP_BYTES}"
        )


def check_chunk(chunk: Chunk) -> None:
    """Check that a chunk is small enough to be decompressed; raises ChunkTooLargeError."""
    _check(chunk.uncompressed_size, chunk.compression, chunk.data[:_FRAME_HEADER], len(chunk.data))


def _check_at(stream: BinaryIO, offset: int) -> int:
    stream.seek(offset)
    opcode, _ = _HEADER.unpack(stream.read(_HEADER.size))
    if opcode != Opcode.CHUNK:
        raise McapError(f"there is no chunk at offset {offset}, although the index lists one")
    _, _, size, _, name_length = _CHUNK.unpack(stream.read(_CHUNK.size))
    name = stream.read(min(name_length, _LONGEST_NAME)).decode("utf-8", "replace")
    (stored,) = _LENGTH.unpack(stream.read(_LENGTH.size))
    return _check(size, name, stream.read(min(stored, _FRAME_HEADER)), stored)


def _check(size: int, compression: str, beginning: bytes, stored: int) -> int:
    """Return the larger of the sizes that a chunk's header and its data give."""
    if compression not in COMPRESSIONS:
        raise McapError(f"a chunk is compressed as {compression!r}; lz4 and zstd can be read")
    largest = max(size, stored, _uncompressed_size(beginning) if compression == "zstd" else 0)
    if largest > MAX_CHUNK_BYTES:
        raise ChunkTooLargeError(
            f"a chunk decompresses to {largest} bytes; the limit is {MAX_CHUNK_BYTES}"
        )
    return largest


def _uncompressed_size(beginning: bytes) -> int:
    import zstandard

    size = zstandard.get_frame_parameters(beginning).content_size
    # A frame without a size is decompressed up to the size in the chunk's header.
    return 0 if size == zstandard.CONTENTSIZE_UNKNOWN else size


def _largest_overlap(indexes: Iterable[ChunkIndex], sizes: Iterable[int]) -> int:
    """Return the largest total size of chunks that overlap in time."""
    changes: list[tuple[int, int, int]] = []
    for index, size in zip(indexes, sizes, strict=True):
        # Chunks overlap if one begins at the moment at which another ends.
        changes.append((index.message_start_time, 0, size))
        changes.append((max(index.message_start_time, index.message_end_time), 1, -size))
    present = largest = 0
    for _, _, change in sorted(changes):
        present += change
        largest = max(largest, present)
    return largest
