"""Chunks that would decompress to gigabytes are refused with a sentence."""

import os
import struct
import tracemalloc
from pathlib import Path

import pytest
import zstandard
from mcap.writer import CompressionType, Writer

from arm_cli.bag.bag_reader import BagReader
from arm_cli.errors import BagError

MANY_ZEROS = 10**9


@pytest.fixture(scope="module")
def zeros():
    """A zstd frame of 100 kB that decompresses to 10^9 zeros, with that size in its header."""
    compressor = zstandard.ZstdCompressor(level=1).compressobj(size=MANY_ZEROS)
    piece = bytes(10**7)
    return b"".join([*(compressor.compress(piece) for _ in range(100)), compressor.flush()])


def write(path: Path, chunks: int = 1, finished: bool = True) -> bytes:
    """Write a bag with `chunks` chunks of one message each, all of the same time."""
    with path.open("wb") as stream:
        writer = Writer(stream, chunk_size=1, compression=CompressionType.ZSTD)
        writer.start()
        schema = writer.register_schema("std_msgs/msg/String", "ros2msg", b"string data")
        channel = writer.register_channel("/x", "cdr", schema)
        for _ in range(chunks):
            writer.add_message(channel, 5, b"hello" * 100, 5)
        if finished:
            writer.finish()
    return path.read_bytes()


def with_chunk_data(content: bytes, data: bytes) -> bytes:
    """Return an unfinished file whose only chunk holds these data instead."""
    at = content.index(b"\x04\x00\x00\x00zstd") + 8
    (length,) = struct.unpack_from("<Q", content, at)
    return content[:at] + struct.pack("<Q", len(data)) + data + content[at + 8 + length :]


def refusal(path: Path) -> str:
    tracemalloc.start()
    try:
        with pytest.raises(BagError) as caught, BagReader(path) as bag:
            list(bag.messages(["/x"]))
        assert tracemalloc.get_traced_memory()[1] < 100e6
    finally:
        tracemalloc.stop()
    return str(caught.value)


def test_a_chunk_with_an_absurd_size_is_refused(tmp_path):
    content = bytearray(write(tmp_path / "a.mcap"))
    at = content.index(b"\x04\x00\x00\x00zstd") - 12
    struct.pack_into("<Q", content, at, 10**12)
    (tmp_path / "a.mcap").write_bytes(content)
    assert "a chunk decompresses to 1000000000000 bytes; the limit is 200000000" in refusal(
        tmp_path / "a.mcap"
    )


@pytest.mark.parametrize("finished", [True, False])
def test_data_larger_than_their_chunk_s_size_are_refused(tmp_path, zeros, finished):
    content = write(tmp_path / "a.mcap", finished=finished)
    if finished:
        # The chunk keeps its length: the beginning of a frame is enough.
        at = content.index(b"\x04\x00\x00\x00zstd") + 16
        content = content[:at] + zeros[:18] + content[at + 18 :]
    else:
        content = with_chunk_data(content, zeros)
        start = content.index(b"\x06", 8 + 9)
        (length,) = struct.unpack_from("<Q", content, start + 1)
        grown = struct.pack("<Q", len(content) - start - 9)
        content = content[: start + 1] + grown + content[start + 9 :]
        assert length
    (tmp_path / "a.mcap").write_bytes(content)
    assert f"a chunk decompresses to {MANY_ZEROS} bytes" in refusal(tmp_path / "a.mcap")


def test_overlapping_chunks_are_counted_together(tmp_path, monkeypatch):
    write(tmp_path / "a.mcap", chunks=20)
    with BagReader(tmp_path / "a.mcap") as bag:
        assert len(list(bag.messages(["/x"]))) == 20
    monkeypatch.setattr("arm_cli.bag.chunk_sizes.MAX_OVERLAP_BYTES", 3000)
    assert "chunks of the same time decompress to" in refusal(tmp_path / "a.mcap")


def test_a_fifo_is_not_a_bag(tmp_path):
    os.mkfifo(tmp_path / "a.mcap")
    with pytest.raises(BagError, match="is neither a folder nor a regular file"):
        BagReader(tmp_path / "a.mcap")


@pytest.mark.parametrize("kind", ["fifo", "device"])
def test_only_regular_files_of_a_folder_are_read(tmp_path, kind):
    if kind == "fifo":
        os.mkfifo(tmp_path / "a.mcap")
    else:
        (tmp_path / "a.mcap").symlink_to("/dev/zero")
    with pytest.raises(
        BagError, match=f"it is a {kind}, not a regular file".replace("fifo", "FIFO")
    ):
        BagReader(tmp_path)
