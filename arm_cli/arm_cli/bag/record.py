"""`arm bag record`: records topics to a bag."""

import argparse
import os
import time
from pathlib import Path
from typing import TYPE_CHECKING

from arm_cli.arguments import (
    Argument,
    Flag,
    Group,
    node_name,
    positive_number,
    positive_whole_number,
    verb,
    whole_number,
)
from arm_cli.errors import BagError, CommandUsageError, StoppedError
from arm_cli.output import complain
from arm_cli.ros import completers
from arm_cli.ros.connection import connect
from arm_node.ros_distribution import ros_distribution

if TYPE_CHECKING:
    from collections import Counter

    from arm_cli.bag.topic_selection import TopicSelection
    from arm_cli.bag_format.metadata import BagMetadata
    from arm_cli.bag_format.writer import BagSettings

CACHE_BYTES = 100 * 1024 * 1024
POLL_MS = 100
NODE_NAME = "rosbag2_recorder"

_PRESETS = {"none": "none", "fastwrite": "none", "zstd_fast": "zstd", "zstd_small": "zstd"}
"""rosbag2's presets for MCAP, with the compression of each."""


@verb(
    Group(
        "topics",
        Argument(
            "names",
            nargs="*",
            metavar="TOPIC",
            help="topics to record",
            completer=completers.topics,
        ),
        Argument("--topics", nargs="+", metavar="TOPIC", help="more topics to record"),
        Flag(
            "-a",
            "--all",
            "--all-topics",
            help="record all topics except hidden ones, including topics that appear later",
        ),
        Argument("-e", "--regex", metavar="REGEX", help="record topics that match"),
        Argument("--exclude-topics", nargs="+", metavar="TOPIC", help="leave out these"),
        Argument("--exclude-regex", metavar="REGEX", help="leave out topics that match"),
        Flag("--include-hidden-topics", help="let --all and --regex include hidden topics"),
    ),
    Group(
        "bag",
        Argument(
            "-o", "--output", metavar="DIR", help="folder to create (default rosbag2_<date>-<time>)"
        ),
        Argument("-s", "--storage", choices=("mcap",), default="mcap", help="its format"),
        Argument(
            "-b",
            "--max-bag-size",
            "--max-size",
            type=whole_number,
            default=0,
            metavar="BYTES",
            help="start a new file at this size (default 0: never)",
        ),
        Argument(
            "-d",
            "--max-bag-duration",
            "--max-duration",
            type=positive_number,
            metavar="SECONDS",
            help="start a new file after this time, and go on until Ctrl-C",
        ),
        # No option of ros2 bag record either: the error says what ends a recording.
        Argument("--duration", help=argparse.SUPPRESS),
        Argument(
            "--compression",
            "--compression-format",
            choices=("none", "lz4", "zstd"),
            help="compression of the files' chunks (default none); every MCAP reader supports it",
        ),
        Argument(
            "--compression-mode",
            choices=("none", "file", "message"),
            default="none",
            help="accepted as in rosbag2; chunks are always compressed, so that files stay "
            "readable",
        ),
        Argument(
            "--storage-preset-profile",
            choices=tuple(_PRESETS),
            default="none",
            help="compression by the name of rosbag2's preset",
        ),
    ),
    Flag("--no-discovery", help="record only topics that exist at the start"),
    Argument(
        "-p",
        "--polling-interval",
        type=positive_whole_number,
        default=POLL_MS,
        metavar="MS",
        help=f"how often to look for new topics (default {POLL_MS} ms)",
    ),
    Argument(
        "--max-cache-size",
        type=whole_number,
        default=CACHE_BYTES,
        metavar="BYTES",
        help="size of the cache for messages that wait for the disk; further messages are dropped "
        f"and counted (default {CACHE_BYTES}); 0 writes each message at once",
    ),
    Flag("--use-sim-time", help="stamp messages with the time of /clock"),
    Argument(
        "--qos-profile-overrides-path",
        type=Path,
        metavar="FILE",
        help="YAML with the quality of service of subscriptions, by topic",
    ),
    # Accepted because command lines for ros2 use it. There are no keyboard controls here.
    Flag("--disable-keyboard-controls", help=argparse.SUPPRESS),
    Argument(
        "--node-name",
        type=node_name,
        default=NODE_NAME,
        metavar="NAME",
        help=f"name of the recording node (default {NODE_NAME})",
    ),
)
def record(options: argparse.Namespace) -> None:
    """Record until a signal arrives."""
    if options.duration is not None:
        raise CommandUsageError(
            f"no option --duration: end a recording with Ctrl-C, or after {options.duration} s "
            f"with: timeout {options.duration} arm bag record ...; --max-bag-duration only begins "
            "a new file"
        )
    from arm_cli.bag_format.offered_qos import read_qos_overrides

    selection = _selection(options)
    overrides = read_qos_overrides(options.qos_profile_overrides_path)
    settings = _settings(options)
    folder = Path(options.output or time.strftime("rosbag2_%Y_%m_%d-%H_%M_%S"))
    from arm_cli.bag.ros_recorder import Recording
    from arm_cli.bag_format.writer import BagWriter

    with connect(options.node_name, options.use_sim_time) as session:
        from arm_cli.bag.ros_recorder import BagRecorder

        for name in selection.names:
            session.full_name(name)  # It raises an error for an invalid name.
        writer = BagWriter(folder, settings)
        recording = Recording(writer, options.max_cache_size)
        recorder = BagRecorder(
            session,
            recording,
            selection,
            options.polling_interval * 1e-3,
            options.use_sim_time,
            overrides,
        )
        if options.max_bag_duration is not None:
            complain(f"A new file begins every {options.max_bag_duration:g} s, until Ctrl-C")
        try:
            if options.use_sim_time:
                session.wait_until(lambda: session.clock_ns() > 0, lambda: "waiting for /clock")
            recorder.run(not options.no_discovery)
        except StoppedError:
            complain("Recording stopped")
        metadata = recording.finish()
    _report(metadata, folder, writer.size_bytes, recording.dropped, recorder.lost)


def _selection(options: argparse.Namespace) -> "TopicSelection":
    from arm_cli.bag.topic_selection import TopicSelection, absolute_names, compile_pattern

    names = absolute_names([*options.names, *(options.topics or ())])
    selection = TopicSelection(
        every=options.all,
        names=names,
        pattern=compile_pattern(options.regex, "--regex"),
        excluded_names=absolute_names(options.exclude_topics),
        excluded_pattern=compile_pattern(options.exclude_regex, "--exclude-regex"),
        hidden=options.include_hidden_topics,
    )
    if selection.is_closed and not names:
        raise BagError(
            "Need to specify at least one option out of --all, --topics or --regex, or topics"
        )
    return selection


def _settings(options: argparse.Namespace) -> "BagSettings":
    from arm_cli.bag_format.writer import BagSettings

    if options.compression_mode != "none" and options.compression is None:
        raise BagError("--compression-mode needs a --compression-format: lz4 or zstd")
    duration_s = options.max_bag_duration
    return BagSettings(
        compression=options.compression or _PRESETS[options.storage_preset_profile],
        max_size_bytes=options.max_bag_size or None,
        max_duration_ns=None if duration_s is None else round(duration_s * 1e9),
        ros_distro=os.environ.get("ROS_DISTRO", ros_distribution()),
    )


def _report(
    metadata: "BagMetadata",
    folder: Path,
    size_bytes: int,
    dropped: "Counter[str]",
    lost: "Counter[str]",
) -> None:
    from arm_cli.bag.info import describe_size

    complain(
        f"{metadata.message_count} messages of {len(metadata.topics)} topics in "
        f"{metadata.span.duration_ns * 1e-9:.1f} s, {describe_size(size_bytes)}, in {folder}"
    )
    if not dropped and not lost:
        complain("No message was dropped")
    for counts, reason in ((dropped, "the disk was too slow"), (lost, "lost in transport")):
        for topic, count in sorted(counts.items()):
            complain(f"{count} messages of {topic} were dropped: {reason}")
