"""One MCAP file while it is being written.

After every flush the file is a whole one: behind its last chunk stands the end of a file without an
index, which the next chunk overwrites. So any reader can read a file whose writer was killed.
"""

import contextlib
from pathlib import Path

from mcap.data_stream import RecordBuilder
from mcap.records import DataEnd, Footer
from mcap.writer import MCAP0_MAGIC, CompressionType, Writer

from arm_cli.bag.bag_metadata import BagFileInfo, TimeSpan
from arm_cli.bag.bag_topic import BagMessage, BagTopic
from arm_cli.bag.offered_qos import offers_to_text
from arm_cli.bag.type_definition import TypeDefinition

PROFILE = "ros2"
LIBRARY = "arm-suite"
CHUNK_BYTES = 768 * 1024
_NEVER_BY_ITSELF = 1 << 62
"""The library's own limit of a chunk: chunks end here, so that their size is known."""

COMPRESSIONS = {
    "none": CompressionType.NONE,
    "lz4": CompressionType.LZ4,
    "zstd": CompressionType.ZSTD,
}


def _end_without_index() -> bytes:
    builder = RecordBuilder()
    DataEnd(data_section_crc=0).write(builder)
    Footer(summary_start=0, summary_offset_start=0, summary_crc=0).write(builder)
    return builder.end() + MCAP0_MAGIC


class McapFileWriter:
    """Writes one file; not thread-safe. Every method but `abandon` may raise an OSError."""

    def __init__(self, path: Path, compression: str) -> None:
        """Create the file.

        Args:
            path: of a file that does not exist.
            compression: of its chunks, one of COMPRESSIONS.
        """
        self._path = path
        self._stream = path.open("xb")
        self._writer = Writer(
            self._stream, chunk_size=_NEVER_BY_ITSELF, compression=COMPRESSIONS[compression]
        )
        self._schemas: dict[str, int] = {}
        self._channels: dict[str, int] = {}
        self._span = TimeSpan()
        self._count = 0
        self._pending_bytes = 0
        self._end = _end_without_index()
        self._writer.start(PROFILE, LIBRARY)
        self.flush()

    @property
    def info(self) -> BagFileInfo:
        """What the file holds by now."""
        return BagFileInfo(self._path.name, self._span, self._count)

    @property
    def size_bytes(self) -> int:
        """The file's size, as if what waits for the next chunk were in it, not compressed."""
        return self._stream.tell() + self._pending_bytes

    def add_topic(self, topic: BagTopic, definition: TypeDefinition) -> None:
        """Announce a topic; before its first message."""
        schema = self._schemas.get(topic.type)
        if schema is None:
            schema = self._writer.register_schema(
                topic.type, definition.encoding, definition.text.encode()
            )
            self._schemas[topic.type] = schema
        self._channels[topic.name] = self._writer.register_channel(
            topic.name,
            topic.serialization_format,
            schema,
            {
                "offered_qos_profiles": offers_to_text(topic.offers),
                "topic_type_hash": topic.type_hash,
            },
        )

    def write(self, message: BagMessage) -> None:
        """Write a message of a topic that was added."""
        self._writer.add_message(
            self._channels[message.topic],
            message.log_time_ns,
            message.data,
            message.publish_time_ns,
        )
        self._span = self._span.with_time(message.log_time_ns)
        self._count += 1
        self._pending_bytes += len(message.data)
        if self._pending_bytes >= CHUNK_BYTES:
            self.flush()

    def flush(self) -> None:
        """Hand everything to the operating system: from now on a kill cannot take it away."""
        self._writer.flush()
        self._pending_bytes = 0
        following = self._stream.tell()
        self._stream.write(self._end)
        self._stream.flush()
        # What follows is longer than the end, a chunk or the index: nothing of it stays behind.
        self._stream.seek(following)

    def close(self, metadata: str) -> None:
        """Finish the file with its index, and the bag's metadata inside."""
        self.flush()
        self._writer.add_metadata("rosbag2", {"serialized_metadata": metadata})
        self._writer.finish()
        self._stream.close()

    def abandon(self) -> None:
        """Close the file as it is, after an error."""
        with contextlib.suppress(OSError):
            self._stream.close()
