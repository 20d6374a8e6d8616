"""`arm bag convert` and `reindex`: rewrite bags, or rebuild the metadata of a bag."""

import argparse
from collections.abc import Iterator, Mapping
from contextlib import ExitStack
from dataclasses import dataclass
from heapq import merge
from pathlib import Path
from typing import TYPE_CHECKING, Any

from arm_cli.arguments import Argument, verb
from arm_cli.bag.info import existing_path
from arm_cli.errors import BagError
from arm_cli.output import say

if TYPE_CHECKING:
    from arm_cli.bag.topic_selection import TopicSelection
    from arm_cli.bag_format.reader import BagReader
    from arm_cli.bag_format.topic import BagMessage, BagTopic, RecordedTopic
    from arm_cli.bag_format.writer import BagSettings

KEYS = (
    "uri",
    "storage_id",
    "all",
    "all_topics",
    "topics",
    "regex",
    "exclude_topics",
    "exclude_regex",
    "compression_format",
    "compression_mode",
    "max_bagfile_size",
    "max_bagfile_duration",
    "storage_preset_profile",
)
"""The keys of the options file, named as in rosbag2."""
COMPRESSIONS = ("", "none", "lz4", "zstd")


@dataclass(frozen=True, slots=True)
class Output:
    """A bag to write."""

    folder: Path
    settings: "BagSettings"
    selection: "TopicSelection"


@verb(
    Argument(
        "-i",
        "--input",
        nargs="+",
        action="append",
        required=True,
        metavar=("BAG", "STORAGE"),
        help="bag to read; repeat it to merge several bags in the order of time",
    ),
    Argument(
        "-o",
        "--output-options",
        required=True,
        metavar="FILE",
        help="YAML with output_bags: a list of bags, each with uri, all_topics or topics, "
        "compression_format, max_bagfile_size, ... as for ros2 bag convert",
    ),
)
def convert(options: argparse.Namespace) -> None:
    """Write the bags."""
    from arm_cli.bag_format.reader import BagReader, warn_if_unfinished

    outputs = read_outputs(Path(options.output_options))
    with ExitStack() as opened:
        readers: list[BagReader] = []
        for path in (_input_path(words) for words in options.input):
            readers.append(opened.enter_context(BagReader(path)))
            warn_if_unfinished(readers[-1], "arm bag convert")
        for output in outputs:
            count = _write(output, readers)
            say(f"wrote {output.folder}: {count} messages")


def _input_path(words: list[str]) -> Path:
    path, *storage = words
    if storage not in ([], [""], ["mcap"]):
        raise BagError(f"--input {path}: storage {' '.join(storage)!r}; only mcap can be read")
    try:
        return existing_path(path)
    except argparse.ArgumentTypeError as error:
        raise BagError(f"--input: {error}") from error


def read_outputs(path: Path) -> list[Output]:
    """Return the bags that an options file describes.

    Raises:
        BagError: the file cannot be read, or holds an unknown option or value.
    """
    from arm_cli.bag_format.yaml_text import load_yaml
    from arm_node.user_file import read_text

    try:
        plain = load_yaml(read_text(path))
    except (OSError, ValueError) as error:
        raise BagError(f"cannot read {path}: {error}") from error
    bags = plain.get("output_bags") if isinstance(plain, dict) else None
    if not isinstance(bags, list) or not bags:
        raise BagError(f"{path} has no list 'output_bags'")
    return [_output(bag, f"{path}, bag {number}") for number, bag in enumerate(bags, start=1)]


def _output(plain: Any, where: str) -> Output:
    from arm_cli.bag.topic_selection import TopicSelection, absolute_names, compile_pattern
    from arm_cli.bag_format.writer import BagSettings
    from arm_node.names import describe_known

    if not isinstance(plain, dict) or not isinstance(plain.get("uri"), str):
        raise BagError(f"{where}: 'uri', the folder to write, is missing")
    for key in plain:
        if key not in KEYS:
            raise BagError(f"{where}: no option {key!r}; {describe_known(str(key), KEYS)}")
    if plain.get("storage_id", "mcap") not in ("", "mcap"):
        raise BagError(f"{where}: storage_id {plain['storage_id']!r}; only mcap can be written")
    compression = str(plain.get("compression_format") or "none")
    if compression not in COMPRESSIONS:
        raise BagError(f"{where}: compression_format {compression!r}; it is none, lz4 or zstd")
    duration_s = _number(plain, "max_bagfile_duration", where)
    return Output(
        folder=Path(plain["uri"]),
        settings=BagSettings(
            compression=compression,
            max_size_bytes=_number(plain, "max_bagfile_size", where) or None,
            max_duration_ns=duration_s * 10**9 if duration_s else None,
        ),
        selection=TopicSelection(
            every=bool(plain.get("all_topics") or plain.get("all")),
            names=absolute_names(_names(plain, "topics", where)),
            pattern=compile_pattern(plain.get("regex") or None, f"{where}: regex"),
            excluded_names=absolute_names(_names(plain, "exclude_topics", where)),
            excluded_pattern=compile_pattern(
                plain.get("exclude_regex") or None, f"{where}: exclude_regex"
            ),
            hidden=True,
        ),
    )


def _number(plain: Mapping[str, Any], key: str, where: str) -> int:
    value = plain.get(key) or 0
    if not isinstance(value, int) or value < 0:
        raise BagError(f"{where}: {key} {value!r} is not a whole number")
    return value


def _names(plain: Mapping[str, Any], key: str, where: str) -> list[str]:
    value = plain.get(key) or []
    if not isinstance(value, list) or not all(isinstance(name, str) for name in value):
        raise BagError(f"{where}: {key} {value!r} is not a list of topics")
    return value


def _write(output: Output, readers: list["BagReader"]) -> int:
    """Write one bag; return the number of its messages."""
    from arm_cli.bag_format.writer import BagWriter

    topics = _wanted(output, readers)
    for reader in readers:
        reader.check_topics(topics.keys())
    writer = BagWriter(output.folder, output.settings)
    try:
        for one in topics.values():
            writer.add_topic(one.topic, one.definition)
        for message in _messages(readers, topics):
            writer.write(message)
        return writer.close().message_count
    except BaseException:  # Ctrl-C must not leave an incomplete bag behind either.
        writer.abandon()
        raise


def _wanted(output: Output, readers: list["BagReader"]) -> dict[str, "RecordedTopic"]:
    wanted: dict[str, RecordedTopic] = {}
    for one in (one for reader in readers for one in reader.recorded_topics):
        name = one.topic.name
        if not output.selection.wants(name):
            continue
        known = wanted.setdefault(name, one)
        if known is one or not one.count:
            continue
        if known.count and not known.is_same(one):
            raise BagError(_different(known.topic, one.topic))
        wanted[name] = known.joined(one) if known.count else one
    if not wanted:
        raise BagError(
            f"nothing to write to {output.folder}: no topic of the bags is selected; select all "
            "with 'all_topics: true', or some with 'topics' or 'regex'"
        )
    return wanted


def _different(one: "BagTopic", other: "BagTopic") -> str:
    kinds = [f"{topic.type} in {topic.serialization_format}" for topic in (one, other)]
    if kinds[0] != kinds[1]:
        return f"{one.name} is {kinds[0]} in one bag, {kinds[1]} in another"
    return (
        f"{one.name}: the bags define {one.type} differently, so that its messages cannot be one "
        "topic; write two bags, or leave the topic out of one with exclude_topics"
    )


def _messages(readers: list["BagReader"], topics: Mapping[str, object]) -> Iterator["BagMessage"]:
    sources = (reader.messages(topics.keys()) for reader in readers)
    return merge(*sources, key=lambda message: message.log_time_ns)


@verb(
    Argument("bag_path", type=existing_path, help="folder of a bag"),
    # Accepted because command lines for ros2 use them. The files themselves tell their format.
    Argument("-s", "--storage", choices=("mcap",), help=argparse.SUPPRESS),
    Argument("storage_id", nargs="?", choices=("mcap",), help=argparse.SUPPRESS),
)
def reindex(options: argparse.Namespace) -> None:
    """Write metadata.yaml."""
    from arm_cli.bag_format.reader import BagReader, warn_if_unfinished
    from arm_cli.bag_format.writer import write_metadata

    with BagReader(options.bag_path, by_metadata=False) as reader:
        warn_if_unfinished(reader, "arm bag reindex")
        path = write_metadata(options.bag_path, reader.metadata)
    say(f"wrote {path}: {reader.metadata.message_count} messages")
