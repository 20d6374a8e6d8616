"""The content of a bag's metadata.yaml."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from arm_cli.bag_format.offered_qos import read_offers
from arm_cli.bag_format.topic import BagTopic
from arm_cli.bag_format.yaml_text import dump_yaml, load_yaml
from arm_cli.errors import BagError

VERSION = 9
"""The version that ROS 2 Jazzy writes, with QoS policies by name."""
ROOT = "rosbag2_bagfile_information"
FILE_NAME = "metadata.yaml"
STORAGE = "mcap"


@dataclass(frozen=True, slots=True)
class TimeSpan:
    """The times of the first and the last message, None without a message.

    Attributes:
        start_ns: since the epoch, or in simulation time.
        end_ns: as `start_ns`.
    """

    start_ns: int | None = None
    end_ns: int | None = None

    @property
    def duration_ns(self) -> int:
        """The duration, 0 without a message."""
        return 0 if self.start_ns is None or self.end_ns is None else self.end_ns - self.start_ns

    def with_time(self, time_ns: int) -> "TimeSpan":
        """Return the span extended to a time."""
        if self.start_ns is None or self.end_ns is None:
            return TimeSpan(time_ns, time_ns)
        return TimeSpan(min(self.start_ns, time_ns), max(self.end_ns, time_ns))

    def joined(self, other: "TimeSpan") -> "TimeSpan":
        """Return the span of both."""
        span = self
        for time_ns in (other.start_ns, other.end_ns):
            span = span if time_ns is None else span.with_time(time_ns)
        return span


@dataclass(frozen=True, slots=True)
class BagFileInfo:
    """One file of a bag: its name, and the time span and number of its messages."""

    name: str
    span: TimeSpan
    message_count: int


@dataclass(frozen=True, slots=True)
class BagMetadata:
    """Everything about a bag except its messages.

    Attributes:
        files: the files in the order of their messages.
        topics: the topics, each with its number of messages.
        ros_distro: the ROS distribution that recorded the bag.
        storage: the format of the files.
        compression_mode: what rosbag2 compressed, FILE or MESSAGE; empty for neither.
        compression_format: how it did.
        custom_data: what its users added.
    """

    files: tuple[BagFileInfo, ...]
    topics: tuple[tuple[BagTopic, int], ...]
    ros_distro: str = ""
    storage: str = STORAGE
    compression_mode: str = ""
    compression_format: str = ""
    custom_data: Mapping[str, Any] | None = None

    @property
    def span(self) -> TimeSpan:
        """The time span of all messages."""
        span = TimeSpan()
        for file in self.files:
            span = span.joined(file.span)
        return span

    @property
    def message_count(self) -> int:
        """The number of all messages."""
        return sum(file.message_count for file in self.files)

    def to_yaml(self) -> str:
        """Return the text of metadata.yaml."""
        return dump_yaml({ROOT: self.to_plain()})

    def to_plain(self) -> dict[str, Any]:
        """Return the content of metadata.yaml below its root key."""
        return {
            "version": VERSION,
            "storage_identifier": self.storage,
            **_span_to_plain(self.span),
            "message_count": self.message_count,
            "topics_with_message_count": [
                {"topic_metadata": _topic_to_plain(topic), "message_count": count}
                for topic, count in self.topics
            ],
            "compression_format": self.compression_format,
            "compression_mode": self.compression_mode,
            "relative_file_paths": [file.name for file in self.files],
            "files": [
                {
                    "path": file.name,
                    **_span_to_plain(file.span),
                    "message_count": file.message_count,
                }
                for file in self.files
            ],
            "custom_data": self.custom_data,
            "ros_distro": self.ros_distro,
        }


def read_metadata(text: str, where: str) -> BagMetadata:
    """Return the metadata in a metadata.yaml of any version up to 9; errors say `where` it is.

    Raises:
        BagError: the text is not the metadata of a bag.
    """
    try:
        plain = load_yaml(text)[ROOT]
        mode = str(plain.get("compression_mode") or "")
        files = plain.get("files") or [{"path": p} for p in plain["relative_file_paths"]]
        return BagMetadata(
            files=tuple(_file(file) for file in files),
            topics=tuple(
                (_topic(entry["topic_metadata"]), int(entry["message_count"]))
                for entry in plain["topics_with_message_count"]
            ),
            ros_distro=str(plain.get("ros_distro") or ""),
            storage=str(plain["storage_identifier"]),
            compression_mode="" if mode.upper() == "NONE" else mode,
            compression_format=str(plain.get("compression_format") or ""),
            custom_data=read_custom_data(plain),
        )
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        reason = f"{type(error).__name__}: {error}".splitlines()[0]
        raise BagError(f"{where} does not hold a bag's metadata ({reason})") from error


def read_custom_data(plain: Mapping[str, Any]) -> dict[str, Any] | None:
    """Return what users added to metadata, given below its root key."""
    custom = plain.get("custom_data")
    return dict(custom) if isinstance(custom, dict) and custom else None


def _span_to_plain(span: TimeSpan) -> dict[str, Any]:
    return {
        "duration": {"nanoseconds": span.duration_ns},
        "starting_time": {"nanoseconds_since_epoch": span.start_ns or 0},
    }


def _topic_to_plain(topic: BagTopic) -> dict[str, Any]:
    return {
        "name": topic.name,
        "type": topic.type,
        "serialization_format": topic.serialization_format,
        "offered_qos_profiles": [offer.to_plain() for offer in topic.offers],
        "type_description_hash": topic.type_hash,
    }


def _topic(plain: dict[str, Any]) -> BagTopic:
    return BagTopic(
        name=str(plain["name"]),
        type=str(plain["type"]),
        type_hash=str(plain.get("type_description_hash") or ""),
        offers=read_offers(plain.get("offered_qos_profiles")),
        serialization_format=str(plain["serialization_format"]),
    )


def _file(plain: dict[str, Any]) -> BagFileInfo:
    count = int(plain.get("message_count", 0))
    if count == 0:
        return BagFileInfo(str(plain["path"]), TimeSpan(), 0)
    start_ns = int(plain["starting_time"]["nanoseconds_since_epoch"])
    end_ns = start_ns + int(plain["duration"]["nanoseconds"])
    return BagFileInfo(str(plain["path"]), TimeSpan(start_ns, end_ns), count)
