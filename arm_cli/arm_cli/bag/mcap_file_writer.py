"""Writes one MCAP file.

After every flush the file is complete. Its last chunk is followed by the end of a file without an
index, which the next chunk overwrites. So any reader can read a file whose writer was killed.
"""

import contextlib
from pathlib import Path

from mcap.data_stream import RecordBuilder
from mcap.records import DataEnd, Footer
from mcap.writer import MCAP0_MAGIC, CompressionType, Writer

from arm_cli.bag.bag_metadata import BagFileInfo, TimeSpan
from arm_cli.bag.bag_topic import BagMessage, BagTopic, TypeDefinition
from arm_cli.bag.offered_qos import offers_to_text

PROFILE = "ros2"
LIBRARY = "arm-suite"
CHUNK_BYTES = 768 * 1024
_UNLIMITED_CHUNK = 1 << 62
"""Keeps the library from ending chunks itself: this class ends them, to know their size."""

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
            path: the path of the file, which must not exist.
            compression: the compression of its chunks, one of COMPRESSIONS.
        """
        self._path = path
        self._stream = path.open("xb")
        self._writer = Writer(
            self._stream, chunk_size=_UNLIMITED_CHUNK, compression=COMPRESSIONS[compression]
        )
        self._schemas: dict[TypeDefinition, int] = {}
        self._channels: dict[str, int] = {}
        self._span = TimeSpan()
        self._count = 0
        self._pending_bytes = 0
        self._end = _end_without_index()
        self._writer.start(PROFILE, LIBRARY)
        self.flush()

    @property
    def info(self) -> BagFileInfo:
        """The name of the file, and the time span and number of its messages so far."""
        return BagFileInfo(self._path.name, self._span, self._count)

    @property
    def size_bytes(self) -> int:
        """The file's size plus the uncompressed size of the pending messages."""
        return self._stream.tell() + self._pending_bytes

    def add_topic(self, topic: BagTopic, definition: TypeDefinition) -> None:
        """Add a topic, before its first message."""
        schema = self._schemas.get(definition, 0)
        if not schema and topic.type:
            # Two definitions of one type name are two schemas.
            schema = self._schemas[definition] = self._writer.register_schema(
                topic.type, definition.encoding, definition.data
            )
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
        """Write a message of an added topic."""
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
        """Hand everything to the operating system, so that it survives a kill."""
        self._writer.flush()
        self._pending_bytes = 0
        chunks_end = self._stream.tell()
        self._stream.write(self._end)
        self._stream.flush()
        # The next chunk or the index is longer than this end, so it overwrites all of it.
        self._stream.seek(chunks_end)

    def close(self, metadata: str) -> None:
        """Finish the file with the bag's metadata and the index."""
        self.flush()
        self._writer.add_metadata("rosbag2", {"serialized_metadata": metadata})
        self._writer.finish()
        self._stream.close()

    def abandon(self) -> None:
        """Close the file as it is, after an error."""
        with contextlib.suppress(OSError):
            self._stream.close()
