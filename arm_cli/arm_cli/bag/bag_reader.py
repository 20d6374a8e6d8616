"""Reads a bag: a folder with MCAP files, or a single MCAP file."""

import os
from collections.abc import Collection, Iterator
from contextlib import ExitStack, closing
from dataclasses import replace
from pathlib import Path

from arm_cli.bag.bag_metadata import FILE_NAME, STORAGE, BagMetadata, read_metadata
from arm_cli.bag.bag_topic import BagMessage, BagTopic, TypeDefinition
from arm_cli.bag.mcap_file_reader import McapFileReader
from arm_cli.errors import BagError
from arm_cli.output import complain
from arm_node.user_file import read_text


class BagReader:
    """Reads a bag; a context manager that closes it.

    The metadata come from the files themselves, because the metadata.yaml of a recorder that was
    killed is older than the last messages.

    Attributes:
        path: the path of the folder or file.
        metadata: everything about the bag except its messages.
        unfinished: the names of the files that their writer did not finish.
        size_bytes: the total size of the files.
    """

    def __init__(self, path: Path, by_metadata: bool = True) -> None:
        """Open all files.

        Args:
            path: the path of the folder or file.
            by_metadata: whether to open the files that metadata.yaml lists, or all MCAP files.

        Raises:
            BagError: there is no bag, or it cannot be read; the message says why.
        """
        self.path = path
        paths, ros_distro = _parts(path, by_metadata)
        with ExitStack() as opening:
            files = [opening.enter_context(closing(McapFileReader(part))) for part in paths]
            self._open_files = opening.pop_all()
        files.sort(key=lambda file: file.info.span.start_ns or 0)
        self._files = files
        self.unfinished = [file.info.name for file in files if not file.is_finished]
        self.size_bytes = sum(file.path.stat().st_size for file in files)
        self.metadata = BagMetadata(
            files=tuple(file.info for file in files),
            topics=_joined(files),
            ros_distro=ros_distro or files[0].ros_distro(),
        )

    @property
    def topics(self) -> list[BagTopic]:
        """All topics."""
        return [topic for topic, _ in self.metadata.topics]

    def definition(self, topic: str) -> TypeDefinition | None:
        """Return the definition of a topic's type from the bag, None if the bag has none."""
        return next(filter(None, (file.definition(topic) for file in self._files)), None)

    def messages(self, topics: Collection[str], start_ns: int = 0) -> Iterator[BagMessage]:
        """Yield the messages of some topics in the order of their time.

        Args:
            topics: the names of the topics.
            start_ns: the time of the earliest message.

        Raises:
            BagError: the bag is damaged.
        """
        for file in self._files:
            end_ns = file.info.span.end_ns
            if end_ns is not None and end_ns >= start_ns:
                yield from file.messages(topics, start_ns)

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


def _parts(path: Path, by_metadata: bool) -> tuple[list[Path], str]:
    """Return the files of a bag, and the ROS distribution in its metadata."""
    if os.path.isfile(path):
        return [_checked(path)], ""
    if not os.path.isdir(path):
        if os.path.exists(path):
            raise BagError(f"Bag path '{path}' is neither a folder nor a regular file")
        raise BagError(f"Bag path '{path}' does not exist!")
    metadata_file = path / FILE_NAME
    if by_metadata and os.path.isfile(metadata_file):
        try:
            text = read_text(metadata_file)
        except (OSError, UnicodeDecodeError) as error:
            raise BagError(f"cannot read {metadata_file}: {error}") from error
        metadata = read_metadata(text, str(metadata_file))
        if metadata.storage != STORAGE:
            raise BagError(_other_storage(path, metadata.storage))
        files = [_checked(path / Path(file.name).name) for file in metadata.files]
        if files:
            return files, metadata.ros_distro
    found = sorted(path.glob("*.mcap"))
    if found:
        return found, ""
    if any(path.glob("*.db3")):
        raise BagError(_other_storage(path, "sqlite3"))
    raise BagError(
        f"the folder {path} is not a bag: it holds neither {FILE_NAME} nor an .mcap file"
    )


def _checked(path: Path) -> Path:
    if path.suffix == ".db3":
        raise BagError(_other_storage(path, "sqlite3"))
    if path.suffix == ".zstd":
        raise BagError(f"{path} is compressed as a whole; decompress it first: unzstd {path}")
    return path


def _other_storage(path: Path, storage: str) -> str:
    return (
        f"{path} is stored as {storage}, but only {STORAGE} can be read; "
        "convert it with `ros2 bag convert` or `rosbags-convert`"
    )


def _joined(files: list[McapFileReader]) -> tuple[tuple[BagTopic, int], ...]:
    """Return the topics of all files, each once, with the number of its messages."""
    topics: dict[str, BagTopic] = {}
    counts: dict[str, int] = {}
    for file in files:
        for topic, count in file.topics:
            known = topics.setdefault(topic.name, topic)
            if not known.offers and topic.offers:
                topics[topic.name] = replace(known, offers=topic.offers)
            counts[topic.name] = counts.get(topic.name, 0) + count
    return tuple((topic, counts[name]) for name, topic in topics.items())
