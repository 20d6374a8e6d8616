"""Reads one MCAP file, finished or not."""

import io
from collections.abc import Collection, Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import BinaryIO

from mcap.reader import SeekingReader
from mcap.records import Statistics
from mcap.stream_reader import MAGIC_SIZE
from mcap.summary import Summary
from mcap.writer import MCAP0_MAGIC

from arm_cli.bag.bag_metadata import BagFileInfo, TimeSpan
from arm_cli.bag.bag_topic import ENCODING, BagMessage, BagTopic, TypeDefinition
from arm_cli.bag.chunk_sizes import MAX_CHUNK_BYTES, check_chunks
from arm_cli.bag.mcap_recovery import damage_errors, recover_summary
from arm_cli.bag.offered_qos import read_offers
from arm_cli.bag.yaml_text import load_yaml
from arm_cli.errors import BagError
from arm_node.user_file import open_file


class _RecoveringReader(SeekingReader):
    """Reads a file that has no summary, with a reconstructed one."""

    def __init__(self, stream: BinaryIO) -> None:
        super().__init__(stream, validate_crcs=True)
        self._recovered = recover_summary(stream)

    def get_summary(self) -> Summary:
        return self._recovered


class McapFileReader:
    """Reads one file.

    Attributes:
        path: the path of the file.
        is_finished: whether its writer finished it and wrote the index.
        info: its name, and the time span and number of its messages.
        topics: its topics, each with its number of messages.
    """

    def __init__(self, path: Path) -> None:
        """Open the file, and scan it if it has no summary.

        Raises:
            BagError: the file cannot be opened, or is damaged.
        """
        self.path = path
        try:
            self._stream = open_file(path)
        except OSError as error:
            raise BagError(f"cannot read {path}: {error.strerror}") from error
        with ExitStack() as opening:
            opening.callback(self._stream.close)
            if self._stream.read(MAGIC_SIZE) != MCAP0_MAGIC:
                raise BagError(f"{path} is not an MCAP file")
            try:
                self._reader, self._summary, self.is_finished = _open_reader(self._stream)
                check_chunks(self._stream, self._summary.chunk_indexes)
                self.topics = _topics(self._summary)
            except damage_errors() as error:
                raise self._damaged(error) from error
            opening.pop_all()
        self.info = BagFileInfo(path.name, *_extent(self._summary.statistics))

    def close(self) -> None:
        """Close the file."""
        self._stream.close()

    def ros_distro(self) -> str:
        """Return the ROS distribution that recorded the file, empty if unknown."""
        if not self.is_finished:
            return ""
        try:
            for record in self._reader.iter_metadata():
                text = record.metadata.get("serialized_metadata", "")
                plain = load_yaml(text) if record.name == "rosbag2" else None
                if isinstance(plain, dict):
                    return str(plain.get("ros_distro") or "")
        except damage_errors():
            pass
        return ""

    def definition(self, topic: str) -> TypeDefinition | None:
        """Return the definition of a topic's type from the file, None if the file has none."""
        for channel in self._summary.channels.values():
            schema = self._summary.schemas.get(channel.schema_id)
            if channel.topic == topic and schema is not None and schema.encoding == ENCODING:
                return TypeDefinition(schema.name, schema.data.decode("utf-8", "replace"))
        return None

    def messages(self, topics: Collection[str], start_ns: int) -> Iterator[BagMessage]:
        """Yield the messages of some topics in the order of their time.

        Args:
            topics: the names of the topics.
            start_ns: the time of the earliest message.

        Raises:
            BagError: the file is damaged.
        """
        # A file without chunks has no index to sort by, so its messages come in file order.
        sort = bool(self._summary.chunk_indexes)
        found = self._reader.iter_messages(topics, starting_at=start_ns, log_time_order=sort)
        try:
            for _, channel, message in found:
                yield BagMessage(
                    channel.topic, message.log_time, message.publish_time, message.data
                )
        except damage_errors() as error:
            if self.is_finished or sort:
                raise self._damaged(error) from error
            # An unfinished file may end with a torn record.

    def _damaged(self, error: Exception) -> BagError:
        reason = str(error).splitlines()[0] if str(error) else type(error).__name__
        return BagError(f"{self.path} is damaged: {reason}")


def _open_reader(stream: BinaryIO) -> tuple[SeekingReader, Summary, bool]:
    """Return a reader, the summary, and whether the summary is the file's own."""
    ends = _ends_well(stream)
    stream.seek(0)
    if ends:
        reader = SeekingReader(stream, validate_crcs=True, record_size_limit=MAX_CHUNK_BYTES)
        summary = reader.get_summary()
        if summary is not None and summary.statistics is not None and not _hides_chunks(summary):
            return reader, summary, True
        stream.seek(0)
    recovering = _RecoveringReader(stream)
    return recovering, recovering.get_summary(), False


def _hides_chunks(summary: Summary) -> bool:
    """Return whether the file has chunks but no index of them, so that it must be scanned."""
    return not summary.chunk_indexes and bool(summary.statistics and summary.statistics.chunk_count)


def _ends_well(stream: BinaryIO) -> bool:
    size = stream.seek(0, io.SEEK_END)
    if size < 2 * MAGIC_SIZE:
        return False
    stream.seek(size - MAGIC_SIZE)
    return stream.read(MAGIC_SIZE) == MCAP0_MAGIC


def _topics(summary: Summary) -> list[tuple[BagTopic, int]]:
    counts = summary.statistics.channel_message_counts if summary.statistics else {}
    return [
        (
            BagTopic(
                name=channel.topic,
                type=summary.schemas[channel.schema_id].name if channel.schema_id else "",
                type_hash=channel.metadata.get("topic_type_hash", ""),
                offers=read_offers(channel.metadata.get("offered_qos_profiles", "")),
                serialization_format=channel.message_encoding,
            ),
            counts.get(channel.id, 0),
        )
        for channel in summary.channels.values()
    ]


def _extent(statistics: Statistics | None) -> tuple[TimeSpan, int]:
    if statistics is None or statistics.message_count == 0:
        return TimeSpan(), 0
    span = TimeSpan(statistics.message_start_time, statistics.message_end_time)
    return span, statistics.message_count
