"""Writes a bag: a folder with MCAP files and their metadata.

After every flush a file is complete. Its last chunk is followed by the end of a file without an
index, which the next chunk overwrites. So any reader can read a file whose writer was killed.
"""

import contextlib
import os
from dataclasses import dataclass
from pathlib import Path

from mcap.data_stream import RecordBuilder
from mcap.records import DataEnd, Footer
from mcap.writer import MCAP0_MAGIC, CompressionType, Writer

from arm_cli.bag_format.metadata import FILE_NAME, BagFileInfo, BagMetadata, TimeSpan, read_metadata
from arm_cli.bag_format.offered_qos import offers_to_text
from arm_cli.bag_format.topic import BagMessage, BagTopic, TypeDefinition
from arm_cli.bag_format.yaml_text import dump_yaml
from arm_cli.errors import BagError

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
        """Create the file, which must not exist; one of COMPRESSIONS is for its chunks."""
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


@dataclass(frozen=True, slots=True)
class BagSettings:
    """Options for writing a bag; without a limit of size or duration it has one file."""

    compression: str = "none"
    max_size_bytes: int | None = None
    max_duration_ns: int | None = None
    ros_distro: str = "jazzy"


class BagWriter:
    """Writes a bag; not thread-safe."""

    def __init__(self, folder: Path, settings: BagSettings) -> None:
        """Create the folder and the first file.

        Raises:
            BagError: the folder exists, or cannot be created.
        """
        self.folder = folder
        self._settings = settings
        self._topics: dict[str, tuple[BagTopic, TypeDefinition]] = {}
        self._counts: dict[str, int] = {}
        self._closed: list[BagFileInfo] = []
        try:
            folder.mkdir(parents=True)
        except FileExistsError as error:
            raise BagError(f"Output folder '{folder}' already exists.") from error
        except OSError as error:
            raise BagError(f"Could not create bag folder '{folder}': {error.strerror}") from error
        try:
            self._file = self._open_next()
            self._write_metadata()
        except OSError as error:
            raise _cannot_write(folder, error) from error

    @property
    def metadata(self) -> BagMetadata:
        """The metadata of the bag so far."""
        return BagMetadata(
            files=(*self._closed, self._file.info),
            topics=tuple((topic, self._counts[name]) for name, (topic, _) in self._topics.items()),
            ros_distro=self._settings.ros_distro,
        )

    @property
    def size_bytes(self) -> int:
        """The size of the bag's files."""
        return sum(path.stat().st_size for path in self.folder.glob("*.mcap"))

    def add_topic(self, topic: BagTopic, definition: TypeDefinition) -> None:
        """Add a topic, once and before its first message.

        Raises:
            BagError: the bag cannot be written.
        """
        self._topics[topic.name] = (topic, definition)
        self._counts[topic.name] = 0
        self._file.add_topic(topic, definition)

    def write(self, message: BagMessage) -> None:
        """Write a message of an added topic.

        Raises:
            BagError: the bag cannot be written.
        """
        try:
            if self._is_full(message.log_time_ns):
                self.split()
            self._file.write(message)
        except OSError as error:
            raise _cannot_write(self.folder, error) from error
        self._counts[message.topic] += 1

    def split(self) -> str:
        """Finish the file, so that it has its index, and begin the next; return its name.

        Raises:
            BagError: the bag cannot be written.
        """
        finished = self._file.info
        try:
            self._file.close(dump_yaml(self.metadata.to_plain()))
            self._closed.append(finished)
            self._file = self._open_next()
            for topic, definition in self._topics.values():
                self._file.add_topic(topic, definition)
            self._write_metadata()
        except OSError as error:
            raise _cannot_write(self.folder, error) from error
        return finished.name

    def flush(self) -> None:
        """Write everything so far, metadata included, so that it survives a kill.

        Raises:
            BagError: the bag cannot be written.
        """
        try:
            self._file.flush()
            self._write_metadata()
        except OSError as error:
            raise _cannot_write(self.folder, error) from error

    def close(self) -> BagMetadata:
        """Finish the bag; return its metadata.

        Raises:
            BagError: the bag cannot be written.
        """
        metadata = self.metadata
        try:
            self._file.close(dump_yaml(metadata.to_plain()))
            self._write_metadata()
        except OSError as error:
            raise _cannot_write(self.folder, error) from error
        return metadata

    def abandon(self) -> None:
        """Leave the bag as it is, after an error."""
        self._file.abandon()

    def _is_full(self, time_ns: int) -> bool:
        span, settings = self._file.info.span, self._settings
        if span.start_ns is None:
            return False
        if settings.max_size_bytes is not None and self._file.size_bytes >= settings.max_size_bytes:
            return True
        limit_ns = settings.max_duration_ns
        return limit_ns is not None and time_ns - span.start_ns >= limit_ns

    def _open_next(self) -> McapFileWriter:
        path = self.folder / f"{self.folder.name}_{len(self._closed)}.mcap"
        return McapFileWriter(path, self._settings.compression)

    def _write_metadata(self) -> None:
        _replace_metadata(self.folder, self.metadata)


def write_metadata(folder: Path, metadata: BagMetadata) -> Path:
    """Write a bag's metadata.yaml; return its path.

    An older file stays until the new one has been read back.

    Raises:
        BagError: the file cannot be written, or does not say what it was meant to.
    """
    try:
        return _replace_metadata(folder, metadata, check=True)
    except OSError as error:
        raise _cannot_write(folder, error) from error


def _replace_metadata(folder: Path, metadata: BagMetadata, check: bool = False) -> Path:
    # A new file replaces the old one atomically, so that a reader always finds a complete file.
    path = folder / FILE_NAME
    new = path.with_name(f".{FILE_NAME}.new")
    new.write_text(metadata.to_yaml(), encoding="utf-8")
    if check and read_metadata(new.read_text(encoding="utf-8"), str(new)) != metadata:
        new.unlink()
        raise BagError(f"{path} is left as it was: its new text does not read back as meant")
    os.replace(new, path)
    return path


def _cannot_write(folder: Path, error: OSError) -> BagError:
    return BagError(f"cannot write {folder}: {error.strerror or error}")
