"""`arm bag info` and `list`: the contents of a bag, and the supported bag formats."""

import argparse
import os
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

from arm_cli.arguments import JSON, Argument, Flag, verb
from arm_cli.output import print_json, say, say_document
from arm_node.printable import printable

if TYPE_CHECKING:
    from arm_cli.bag_format.metadata import BagMetadata
    from arm_cli.bag_format.reader import BagReader

SORTINGS = ("name", "type", "count")

_NEXT_LINE = "\n" + " " * 19
_UNITS = ("B", "KiB", "MiB", "GiB", "TiB")
PLUGINS = {
    "storage": ("mcap",),
    "converter": ("cdr",),
    "compressor": ("lz4", "zstd"),
    "decompressor": ("lz4", "zstd"),
}
"""Formats by the kinds that ros2 bag list knows, compression being that of MCAP's chunks."""


def existing_path(text: str) -> Path:
    """Convert an argument to a path, for argparse."""
    path = Path(text)
    if not os.path.exists(path):
        raise argparse.ArgumentTypeError(f"Bag path '{text}' does not exist!")
    return path


@verb(
    Argument("bag_path", type=existing_path, help="folder of a bag, or an .mcap file"),
    Argument("-s", "--storage", choices=("mcap",), default="mcap", help="its format"),
    Flag("-t", "--topic-name", help="print only the names of topics"),
    Argument("--sort", choices=SORTINGS, default="name", help="order of the topics (default name)"),
    # Accepted because command lines for ros2 use it. It lists services, which bags lack here.
    Flag("-v", "--verbose", help=argparse.SUPPRESS),
    JSON,
)
def info(options: argparse.Namespace) -> None:
    """Print the contents of a bag."""
    from arm_cli.bag_format.reader import BagReader, warn_if_unfinished

    with BagReader(options.bag_path) as reader:
        warn_if_unfinished(reader, "arm bag info")
        if options.json:
            print_json(bag_to_plain(reader))
        elif options.topic_name:
            say(*(topic.name for topic in reader.topics))
        else:
            say_document(describe_bag(reader, options.sort))


def describe_bag(reader: "BagReader", sort: str) -> str:
    """Return the description of a bag, with its topics sorted by name, type or count."""
    metadata = reader.metadata
    span = metadata.span
    return "\n".join(
        [
            "",
            f"Files:             {_NEXT_LINE.join(printable(f.name) for f in metadata.files)}",
            f"Bag size:          {describe_size(reader.size_bytes)}",
            f"Storage id:        {printable(metadata.storage)}",
            *_compression_lines(metadata),
            f"ROS Distro:        {printable(metadata.ros_distro or 'unknown')}",
            f"Duration:          {_seconds(span.duration_ns)}s",
            f"Start:             {_point(span.start_ns or 0)}",
            f"End:               {_point(span.end_ns or 0)}",
            f"Messages:          {metadata.message_count}",
            f"Topic information: {_NEXT_LINE.join(_topic_lines(reader, sort))}",
            "Service:           0",
            "Service information: ",
        ]
    )


def bag_to_plain(reader: "BagReader") -> dict[str, Any]:
    """Return the description of a bag as plain values, for JSON."""
    metadata = reader.metadata
    return {
        "files": [file.name for file in metadata.files],
        "size_bytes": reader.size_bytes,
        "storage": metadata.storage,
        "compression_mode": metadata.compression_mode,
        "compression_format": metadata.compression_format,
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
    """Return a number of bytes in a suitable unit."""
    unit = 0
    while size >= 1024 and unit < len(_UNITS) - 1:
        size /= 1024
        unit += 1
    return f"{size:.1f} {_UNITS[unit]}" if unit else f"{size:.0f} B"


def _compression_lines(metadata: "BagMetadata") -> list[str]:
    if not metadata.compression_mode:
        return []
    how = f"{metadata.compression_format} by {metadata.compression_mode.lower()}"
    return [f"Compression:       {printable(how)}"]


def _topic_lines(reader: "BagReader", sort: str) -> list[str]:
    keys = {
        "name": lambda entry: entry[0].name,
        "type": lambda entry: (entry[0].type, entry[0].name),
        "count": lambda entry: (entry[1], entry[0].name),
    }
    return [
        printable(
            f"Topic: {topic.name} | Type: {topic.type} | Count: {count} | "
            f"Serialization Format: {topic.serialization_format}"
        )
        for topic, count in sorted(reader.metadata.topics, key=keys[sort])
    ]


def _seconds(nanoseconds: int) -> str:
    seconds, rest = divmod(nanoseconds, 10**9)
    return f"{seconds}.{rest:09d}"


def _point(time_ns: int) -> str:
    local = time.localtime(time_ns // 10**9)
    clock = f"{time.strftime('%H:%M:%S', local)}.{time_ns % 10**9:09d}"
    return f"{time.strftime('%b %e %Y', local)} {clock} ({_seconds(time_ns)})"


@verb(Argument("plugin_type", choices=tuple(PLUGINS), help="what to list"))
def list_plugins(options: argparse.Namespace) -> None:
    """Print the names."""
    say(*PLUGINS[options.plugin_type])
