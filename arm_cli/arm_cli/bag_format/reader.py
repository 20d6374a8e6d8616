"""Reads a bag: a folder with MCAP files, or a single MCAP file."""

import os
from collections.abc import Collection, Iterator
from contextlib import ExitStack, closing, suppress
from dataclasses import replace
from pathlib import Path

from arm_cli.bag_format.chunk_sizes import MAX_CHUNK_BYTES
from arm_cli.bag_format.mcap_file import McapFileReader
from arm_cli.bag_format.metadata import (
    FILE_NAME,
    STORAGE,
    BagMetadata,
    read_custom_data,
    read_metadata,
)
from arm_cli.bag_format.topic import CDR, BagMessage, BagTopic, RecordedTopic
from arm_cli.errors import BagError
from arm_cli.output import complain
from arm_node.user_file import read_text

COMPRESSION_MODE, COMPRESSION_FORMAT = "MESSAGE", "zstd"
"""How metadata.yaml names the compression of messages one by one, by rosbag2.

Only metadata.yaml says so, which a bag can lose. But no message in CDR begins like a frame of zstd,
so that the messages themselves tell.
"""
_FRAME_START = b"\x28\xb5\x2f\xfd"


def is_compressed(data: bytes) -> bool:
    """Return whether a message, which is CDR if it is not compressed, is compressed."""
    return data[:4] == _FRAME_START


def decompressed(data: bytes, topic: str) -> bytes:
    """Return a message without its compression.

    Raises:
        BagError: the message is damaged, or too large.
    """
    import zstandard

    try:
        # rosbag2 writes the size of the message into the frame.
        size = zstandard.get_frame_parameters(data).content_size
        if size <= MAX_CHUNK_BYTES:
            return zstandard.ZstdDecompressor().decompress(data)
    except zstandard.ZstdError as error:
        raise BagError(f"a compressed message of {topic} is damaged: {error}") from error
    found = "an unknown number of" if size == zstandard.CONTENTSIZE_UNKNOWN else str(size)
    raise BagError(
        f"a message of {topic} decompresses to {found} bytes; the limit is {MAX_CHUNK_BYTES}"
    )


class BagReader:
    """Reads a bag; a context manager that closes it.

    The metadata come from the files themselves, because the metadata.yaml of a recorder that was
    killed is older than the last messages.

    Attributes:
        path: the path of the folder or file.
        metadata: everything about the bag except its messages.
        recorded_topics: the topics; one of several types or definitions is there for each.
        unfinished: the names of the files that their writer did not finish.
        size_bytes: the total size of the files.
    """

    def __init__(self, path: Path, by_metadata: bool = True) -> None:
        """Open the files that metadata.yaml lists, or all MCAP files.

        Raises:
            BagError: there is no bag, or it cannot be read; the message says why.
        """
        self.path = path
        paths, known = _parts(path, by_metadata)
        with ExitStack() as opening:
            files = [opening.enter_context(closing(McapFileReader(part))) for part in paths]
            self._open_files = opening.pop_all()
        files.sort(key=lambda file: file.info.span.start_ns or 0)
        self._files = files
        self.unfinished = [file.info.name for file in files if not file.is_finished]
        self.size_bytes = sum(file.path.stat().st_size for file in files)
        self.recorded_topics = _joined(files)
        embedded = {} if known and known.ros_distro else files[0].embedded_metadata()
        self.metadata = BagMetadata(
            files=tuple(file.info for file in files),
            topics=tuple((one.topic, one.count) for one in self.recorded_topics),
            ros_distro=(known and known.ros_distro) or str(embedded.get("ros_distro") or ""),
            custom_data=known.custom_data if known else read_custom_data(embedded),
        )
        self.metadata = replace(self.metadata, **self._compression(known))

    def _compression(self, known: BagMetadata | None) -> dict[str, str]:
        """Return the compression of the messages, as fields of the metadata."""
        if known and known.compression_mode.upper() == COMPRESSION_MODE:
            if known.compression_format != COMPRESSION_FORMAT:
                self.close()
                raise BagError(
                    f"the messages of {self.path} are compressed as "
                    f"{known.compression_format!r}; only {COMPRESSION_FORMAT} can be read"
                )
            mode = known.compression_mode
        else:
            mode = COMPRESSION_MODE
        if not self._has_compressed_messages():
            return {}
        return {"compression_mode": mode, "compression_format": COMPRESSION_FORMAT}

    def _has_compressed_messages(self) -> bool:
        names = {
            one.topic.name for one in self.recorded_topics if one.topic.serialization_format == CDR
        }
        with suppress(BagError):  # Who reads the messages meets the damage, too.
            for file in self._files:
                for message in file.messages(names, 0):
                    return is_compressed(message.data)
        return False

    @property
    def topics(self) -> list[BagTopic]:
        """All topics."""
        return [topic for topic, _ in self.metadata.topics]

    def check_topics(self, topics: Collection[str]) -> None:
        """Check that each of some topics has one type, one definition and one format.

        Raises:
            BagError: one has several, so that its messages cannot be told apart.
        """
        for name in sorted(topics):
            found = [one for one in self.recorded_topics if one.topic.name == name and one.count]
            if len(found) > 1:
                kinds = ", ".join(
                    f"{one.topic.type} in {one.topic.serialization_format} ({one.count})"
                    for one in found
                )
                raise BagError(
                    f"{name} of {self.path} has messages of several types or definitions: {kinds}; "
                    "leave the topic out"
                )

    def messages(self, topics: Collection[str], start_ns: int = 0) -> Iterator[BagMessage]:
        """Return the messages of some topics from a time on, in the order of their time.

        Raises:
            BagError: the bag is damaged, or `check_topics` refuses a topic.
        """
        self.check_topics(topics)
        return self._messages(topics, start_ns)

    def _messages(self, topics: Collection[str], start_ns: int) -> Iterator[BagMessage]:
        formats = {one.topic.name: one.topic.serialization_format for one in self.recorded_topics}
        for file in self._files:
            end_ns = file.info.span.end_ns
            if end_ns is None or end_ns < start_ns:
                continue
            for message in file.messages(topics, start_ns):
                name = message.topic
                if formats[name] == CDR and is_compressed(message.data):
                    data = decompressed(message.data, f"{name} of {self.path}")
                    yield message._replace(data=data)
                else:
                    yield message

    def close(self) -> None:
        """Close all files."""
        self._open_files.close()

    def __enter__(self) -> "BagReader":
        """Return the reader."""
        return self

    def __exit__(self, *_: object) -> None:
        """Close all files."""
        self.close()


def warn_if_unfinished(reader: BagReader, program: str) -> None:
    """Print a warning if the bag has unfinished files."""
    if reader.unfinished:
        complain(
            f"{program}: {', '.join(reader.unfinished)} was not finished: it is being recorded, or "
            "its recorder was killed. Everything up to its last complete chunk is readable."
        )


def _parts(path: Path, by_metadata: bool) -> tuple[list[Path], BagMetadata | None]:
    """Return the files of a bag, and its metadata.yaml if it has one that is used."""
    if os.path.isfile(path):
        return [_checked(path)], None
    if not os.path.isdir(path):
        if os.path.exists(path):
            raise BagError(f"Bag path '{path}' is neither a folder nor a regular file")
        raise BagError(f"Bag path '{path}' does not exist!")
    known = None
    try:
        known = recorded_metadata(path)
    except BagError:
        if by_metadata:
            raise
    if known and by_metadata:
        if known.storage != STORAGE:
            raise BagError(_other_storage(path, known.storage))
        files = [_checked(path / Path(file.name).name) for file in known.files]
        if files:
            return files, known
    found = sorted(path.glob("*.mcap"))
    if found:
        return found, known
    if any(path.glob("*.db3")):
        raise BagError(_other_storage(path, "sqlite3"))
    for compressed in sorted(path.glob("*.zstd")):
        _checked(compressed)
    raise BagError(
        f"the folder {path} is not a bag: it holds neither {FILE_NAME} nor an .mcap file"
    )


def recorded_metadata(folder: Path) -> BagMetadata | None:
    """Return the content of a bag's metadata.yaml, None without the file.

    Raises:
        BagError: the file cannot be read.
    """
    file = folder / FILE_NAME
    if not os.path.isfile(file):
        return None
    try:
        text = read_text(file)
    except (OSError, UnicodeDecodeError) as error:
        raise BagError(f"cannot read {file}: {error}") from error
    return read_metadata(text, str(file))


def _checked(path: Path) -> Path:
    if path.suffix == ".db3":
        raise BagError(_other_storage(path, "sqlite3"))
    if path.suffix == ".zstd":
        raise BagError(
            f"{path} is compressed as a whole; decompress it first: "
            f"unzstd {path} && arm bag reindex {path.parent}"
        )
    return path


def _other_storage(path: Path, storage: str) -> str:
    return (
        f"{path} is stored as {storage}, but only {STORAGE} can be read; "
        "convert it with `ros2 bag convert` or `rosbags-convert`"
    )


def _joined(files: list[McapFileReader]) -> list[RecordedTopic]:
    """Return the topics of all files, each once, with the number of its messages."""
    joined: list[RecordedTopic] = []
    for one in (one for file in files for one in file.topics):
        for place, known in enumerate(joined):
            if known.is_same(one):
                joined[place] = known.joined(one)
                break
        else:
            joined.append(one)
    filled = {one.topic.name for one in joined if one.count}
    return [one for one in joined if one.count or one.topic.name not in filled]
