"""A bag in ros2 bag info's lines."""

import time
from typing import Any

from arm_cli.bag.bag_reader import BagReader

_INDENT = " " * 19
_UNITS = ("B", "KiB", "MiB", "GiB", "TiB")


def describe_bag(reader: BagReader, sort: str) -> str:
    """Return the text, its topics sorted by name, type or count."""
    metadata = reader.metadata
    span = metadata.span
    return "\n".join(
        [
            "",
            f"Files:             {f'{chr(10)}{_INDENT}'.join(f.name for f in metadata.files)}",
            f"Bag size:          {describe_size(reader.size_bytes)}",
            f"Storage id:        {metadata.storage}",
            f"ROS Distro:        {metadata.ros_distro or 'unknown'}",
            f"Duration:          {_seconds(span.duration_ns)}s",
            f"Start:             {_point(span.start_ns or 0)}",
            f"End:               {_point(span.end_ns or 0)}",
            f"Messages:          {metadata.message_count}",
            f"Topic information: {f'{chr(10)}{_INDENT}'.join(_topic_lines(reader, sort))}",
            "Service:           0",
            "Service information: ",
        ]
    )


def bag_to_plain(reader: BagReader) -> dict[str, Any]:
    """Return the same as plain values, for JSON."""
    metadata = reader.metadata
    return {
        "files": [file.name for file in metadata.files],
        "size_bytes": reader.size_bytes,
        "storage": metadata.storage,
        "ros_distro": metadata.ros_distro,
        "start_ns": metadata.span.start_ns,
        "end_ns": metadata.span.end_ns,
        "duration_s": metadata.span.duration_ns * 1e-9,
        "message_count": metadata.message_count,
        "unfinished": reader.unfinished,
        "topics": [
            {
                "name": topic.name,
                "type": topic.type,
                "type_hash": topic.type_hash,
                "count": count,
                "qos": [offer.to_plain() for offer in topic.offers],
            }
            for topic, count in metadata.topics
        ],
    }


def describe_size(size: float) -> str:
    """Return a number of bytes in a unit that fits."""
    unit = 0
    while size >= 1024 and unit < len(_UNITS) - 1:
        size /= 1024
        unit += 1
    return f"{size:.1f} {_UNITS[unit]}" if unit else f"{size:.0f} B"


def _topic_lines(reader: BagReader, sort: str) -> list[str]:
    keys = {
        "name": lambda entry: entry[0].name,
        "type": lambda entry: (entry[0].type, entry[0].name),
        "count": lambda entry: (entry[1], entry[0].name),
    }
    return [
        f"Topic: {topic.name} | Type: {topic.type} | Count: {count} | "
        f"Serialization Format: {topic.serialization_format}"
        for topic, count in sorted(reader.metadata.topics, key=keys[sort])
    ]


def _seconds(nanoseconds: int) -> str:
    seconds, rest = divmod(nanoseconds, 10**9)
    return f"{seconds}.{rest:09d}"


def _point(time_ns: int) -> str:
    local = time.localtime(time_ns // 10**9)
    clock = f"{time.strftime('%H:%M:%S', local)}.{time_ns % 10**9:09d}"
    return f"{time.strftime('%b %e %Y', local)} {clock} ({_seconds(time_ns)})"
