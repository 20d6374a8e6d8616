"""Chunks and messages that decompress to more than the limit are refused before they are.

A frame of zstd names the size of its content. mcap 1.6 and zstandard 0.25 allocate what it names,
gigabytes for some kilobytes. The limit is lowered here, so that small ones are beyond it.
"""

import os
import struct
from pathlib import Path

import pytest
import zstandard
from mcap.writer import CompressionType, Writer

from arm_cli.bag_format.reader import BagReader, decompressed
from arm_cli.errors import BagError

LIMIT = 2000
TOO_MUCH = 5000


@pytest.fixture
def zeros():
    """A frame of more zeros than the limit allows, with their number in its header."""
    return zstandard.ZstdCompressor().compress(bytes(TOO_MUCH))


@pytest.fixture(autouse=True)
def low_limit(monkeypatch):
    for module in ("chunk_sizes", "mcap_file", "reader"):
        monkeypatch.setattr(f"arm_cli.bag_format.{module}.MAX_CHUNK_BYTES", LIMIT)


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


def refusal(path: Path, monkeypatch) -> str:
    """Return why a file is refused; nothing of it may be decompressed before."""
    monkeypatch.setattr("zstandard.decompress", lambda *_: pytest.fail("it was decompressed"))
    with pytest.raises(BagError) as caught, BagReader(path) as bag:
        list(bag.messages(["/x"]))
    return str(caught.value)


def test_a_chunk_with_a_size_beyond_the_limit_is_refused(tmp_path, monkeypatch):
    content = bytearray(write(tmp_path / "a.mcap"))
    at = content.index(b"\x04\x00\x00\x00zstd") - 12
    struct.pack_into("<Q", content, at, TOO_MUCH)
    (tmp_path / "a.mcap").write_bytes(content)
    said = refusal(tmp_path / "a.mcap", monkeypatch)
    assert f"a chunk decompresses to {TOO_MUCH} bytes; the limit is {LIMIT}" in said


@pytest.mark.parametrize("finished", [True, False])
def test_data_larger_than_their_chunk_s_size_are_refused(tmp_path, monkeypatch, zeros, finished):
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
    said = refusal(tmp_path / "a.mcap", monkeypatch)
    assert f"a chunk decompresses to {TOO_MUCH} bytes" in said


def test_overlapping_chunks_are_counted_together(tmp_path, monkeypatch):
    write(tmp_path / "a.mcap", chunks=20)
    with BagReader(tmp_path / "a.mcap") as bag:
        assert len(list(bag.messages(["/x"]))) == 20
    monkeypatch.setattr("arm_cli.bag_format.chunk_sizes.MAX_OVERLAP_BYTES", 3000)
    assert "chunks of the same time decompress to" in refusal(tmp_path / "a.mcap", monkeypatch)


@pytest.mark.parametrize(
    ("frame", "reason"),
    [
        ("zeros", f"of /x decompresses to {TOO_MUCH} bytes; the limit is {LIMIT}"),
        ("unsized", "of /x decompresses to an unknown number of bytes"),
        ("torn", "a compressed message of /x is damaged: "),
    ],
)
def test_a_message_that_cannot_be_decompressed_is_refused(zeros, frame, reason):
    small = zstandard.ZstdCompressor().compress(b"hello")
    unsized = zstandard.ZstdCompressor(write_content_size=False).compress(b"hello")
    data = {"zeros": zeros, "unsized": unsized, "torn": small[:-2]}[frame]
    assert decompressed(small, "/x") == b"hello"
    with pytest.raises(BagError) as caught:
        decompressed(data, "/x")
    assert reason in str(caught.value)


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
