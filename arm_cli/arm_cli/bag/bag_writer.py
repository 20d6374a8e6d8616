"""Writes a bag: a folder with MCAP files and their metadata."""

import os
from dataclasses import dataclass
from pathlib import Path

from arm_cli.bag.bag_metadata import FILE_NAME, BagFileInfo, BagMetadata, read_metadata
from arm_cli.bag.bag_topic import BagMessage, BagTopic, TypeDefinition
from arm_cli.bag.mcap_file_writer import McapFileWriter
from arm_cli.bag.yaml_text import dump_yaml
from arm_cli.errors import BagError


@dataclass(frozen=True, slots=True)
class BagSettings:
    """Options for writing a bag.

    Attributes:
        compression: the compression of the chunks: none, lz4 or zstd.
        max_size_bytes: the size at which a new file begins; None means never.
        max_duration_ns: the duration at which a new file begins; None means never.
        ros_distro: the ROS distribution being recorded.
    """

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
                self._split()
            self._file.write(message)
        except OSError as error:
            raise _cannot_write(self.folder, error) from error
        self._counts[message.topic] += 1

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

    def _split(self) -> None:
        self._file.close(dump_yaml(self.metadata.to_plain()))
        self._closed.append(self._file.info)
        self._file = self._open_next()
        for topic, definition in self._topics.values():
            self._file.add_topic(topic, definition)
        self._write_metadata()

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
