"""Reads one MCAP file, finished or not."""

from collections.abc import Collection, Iterator
from contextlib import ExitStack
from heapq import merge
from pathlib import Path
from typing import Any, BinaryIO

from mcap.reader import SeekingReader
from mcap.records import Channel, Message, Statistics
from mcap.stream_reader import MAGIC_SIZE
from mcap.summary import Summary
from mcap.writer import MCAP0_MAGIC

from arm_cli.bag.bag_metadata import BagFileInfo, TimeSpan
from arm_cli.bag.bag_topic import BagMessage, BagTopic, RecordedTopic, TypeDefinition
from arm_cli.bag.chunk_sizes import check_chunks
from arm_cli.bag.mcap_index import damage_errors, read_index
from arm_cli.bag.offered_qos import read_offers
from arm_cli.bag.yaml_text import load_yaml
from arm_cli.errors import BagError
from arm_node.user_file import open_file


class _ChunkReader(SeekingReader):
    """Reads the messages in the chunks of a summary."""

    def __init__(self, stream: BinaryIO, summary: Summary) -> None:
        stream.seek(0)
        super().__init__(stream, validate_crcs=True)
        self._given = summary

    def get_summary(self) -> Summary:
        return self._given


class McapFileReader:
    """Reads one file.

    Attributes:
        path: the path of the file.
        is_finished: whether its writer finished it.
        info: its name, and the time span and number of its messages.
        topics: its topics; one of several types, definitions or formats is there for each.
    """

    def __init__(self, path: Path) -> None:
        """Open the file, and scan it if its summary lacks a part.

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
                index = read_index(self._stream)
                check_chunks(self._stream, index.summary.chunk_indexes)
                self.topics = _topics(index.summary)
            except damage_errors() as error:
                raise self._damaged(error) from error
            opening.pop_all()
        self._summary, self._plain = index.summary, index.plain
        self._reader = _ChunkReader(self._stream, index.summary)
        self.is_finished = index.is_finished
        self.info = BagFileInfo(path.name, *_extent(self._summary.statistics))

    def close(self) -> None:
        """Close the file."""
        self._stream.close()

    def embedded_metadata(self) -> dict[str, Any]:
        """Return what rosbag2 writes of metadata.yaml into the file; empty if there is nothing."""
        try:
            for record in self._reader.iter_metadata():
                if record.name == "rosbag2":
                    plain = load_yaml(record.metadata.get("serialized_metadata", ""))
                    return plain if isinstance(plain, dict) else {}
        except damage_errors():
            pass
        return {}

    def messages(self, topics: Collection[str], start_ns: int) -> Iterator[BagMessage]:
        """Yield the messages of some topics in the order of their time.

        Args:
            topics: the names of the topics.
            start_ns: the time of the earliest message.

        Raises:
            BagError: the file is damaged.
        """
        wanted = set(topics)
        expected = sum(one.count for one in self.topics if one.topic.name in wanted)
        found = 0
        try:
            for channel, message in self._found(wanted, start_ns):
                yield BagMessage(
                    channel.topic, message.log_time, message.publish_time, message.data
                )
                found += 1
        except damage_errors() as error:
            raise self._damaged(error) from error
        if start_ns <= (self.info.span.start_ns or 0) and found != expected:
            raise BagError(
                f"{self.path} is damaged: it counts {expected} messages of these topics, and its "
                f"index leads to {found}"
            )

    def _found(self, topics: Collection[str], start_ns: int) -> Iterator[tuple[Channel, Message]]:
        """Yield the messages in and outside chunks in the order of their time."""
        sources: list[Iterator[tuple[Channel, Message]]] = []
        if self._summary.chunk_indexes:
            chunked = self._reader.iter_messages(topics, starting_at=start_ns)
            sources.append((channel, message) for _, channel, message in chunked)
        sources.append(self._found_plain(topics, start_ns))
        return merge(*sources, key=lambda one: one[1].log_time)

    def _found_plain(
        self, topics: Collection[str], start_ns: int
    ) -> Iterator[tuple[Channel, Message]]:
        plain, channels = self._plain, self._summary.channels
        for index in plain.in_time_order():
            channel = channels[plain.channels[index]]
            if channel.topic in topics and plain.log_times_ns[index] >= start_ns:
                yield channel, plain.read(self._stream, index)

    def _damaged(self, error: Exception) -> BagError:
        reason = str(error).splitlines()[0] if str(error) else type(error).__name__
        return BagError(f"{self.path} is damaged: {reason}")


def _topics(summary: Summary) -> list[RecordedTopic]:
    counts = summary.statistics.channel_message_counts if summary.statistics else {}
    return [
        _topic(channel, summary, counts.get(channel.id, 0)) for channel in summary.channels.values()
    ]


def _topic(channel: Channel, summary: Summary, count: int) -> RecordedTopic:
    schema = summary.schemas.get(channel.schema_id)
    if schema is None and channel.schema_id:
        raise LookupError(f"{channel.topic} has the schema {channel.schema_id}, which is missing")
    definition = (
        TypeDefinition("", b"")
        if schema is None
        else TypeDefinition(schema.name, schema.data, schema.encoding)
    )
    topic = BagTopic(
        name=channel.topic,
        type=definition.name,
        type_hash=channel.metadata.get("topic_type_hash", ""),
        offers=read_offers(channel.metadata.get("offered_qos_profiles", "")),
        serialization_format=channel.message_encoding,
    )
    return RecordedTopic(topic, definition, count)


def _extent(statistics: Statistics | None) -> tuple[TimeSpan, int]:
    if statistics is None or statistics.message_count == 0:
        return TimeSpan(), 0
    span = TimeSpan(statistics.message_start_time, statistics.message_end_time)
    return span, statistics.message_count
