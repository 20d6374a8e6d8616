"""`arm bag play`: publishes the messages of a bag."""

import argparse
import time
from pathlib import Path
from typing import TYPE_CHECKING

from arm_cli.arguments import (
    Argument,
    Flag,
    Group,
    positive_number,
    positive_number_or_zero,
    positive_whole_number,
    verb,
)
from arm_cli.bag.info import existing_path
from arm_cli.errors import BagError, CommandUsageError, NoSuchNameError, StoppedError
from arm_cli.names import absolute_name
from arm_cli.output import complain
from arm_cli.ros.connection import connect
from arm_node.names import describe_known

if TYPE_CHECKING:
    from arm_cli.bag.ros_player import BagPlayer
    from arm_cli.bag_format.reader import BagReader
    from arm_cli.bag_format.topic import RecordedTopic

CLOCK_HZ = 40.0
READ_AHEAD = 1000
NODE_NAME = "rosbag2_player"


def _duration(text: str) -> float:
    # rosbag2's own default is -1.
    duration_s = positive_number(text.removeprefix("-"))
    return float("inf") if text.startswith("-") else duration_s


@verb(
    Argument("bag_path", type=existing_path, help="folder of a bag, or an .mcap file"),
    Argument("-s", "--storage", choices=("mcap",), default="mcap", help="its format"),
    Group(
        "topics",
        Argument("--topics", nargs="+", metavar="TOPIC", help="play only these"),
        Argument("-e", "--regex", metavar="REGEX", help="play topics that match"),
        Argument("--exclude-topics", nargs="+", metavar="TOPIC", help="leave out these"),
        Argument("-x", "--exclude-regex", metavar="REGEX", help="leave out topics that match"),
        Argument(
            "-m",
            "--remap",
            nargs="+",
            default=[],
            metavar="OLD:=NEW",
            help="publish topics under other names",
        ),
        description="By default: all.",
    ),
    Argument(
        "-r", "--rate", type=positive_number, default=1.0, help="speed of playing (default 1.0)"
    ),
    Flag("-l", "--loop", help="start again at the end"),
    Argument(
        "--start-offset",
        type=positive_number_or_zero,
        default=0.0,
        metavar="SECONDS",
        help="skip this much of the beginning",
    ),
    Argument(
        "--playback-duration",
        type=_duration,
        default=float("inf"),
        metavar="SECONDS",
        help="play only this much of the bag; a negative number means all",
    ),
    Argument(
        "--clock",
        type=positive_number,
        nargs="?",
        const=CLOCK_HZ,
        metavar="HZ",
        help=f"publish the bag's time on /clock (without a rate {CLOCK_HZ:g} Hz)",
    ),
    Argument(
        "-d",
        "--delay",
        type=positive_number_or_zero,
        default=0.0,
        metavar="SECONDS",
        help="wait this long before playing, each time with --loop",
    ),
    Argument(
        "--read-ahead-queue-size",
        type=positive_whole_number,
        default=READ_AHEAD,
        metavar="N",
        help=f"number of messages to read before they are due (default {READ_AHEAD})",
    ),
    Argument(
        "--qos-profile-overrides-path",
        type=Path,
        metavar="FILE",
        help="YAML with the quality of service of publishers, by topic",
    ),
    # Accepted because command lines for ros2 use it. There are no keyboard controls here.
    Flag("--disable-keyboard-controls", help=argparse.SUPPRESS),
)
def play(options: argparse.Namespace) -> None:
    """Play until the end or until a signal arrives."""
    from arm_cli.bag_format.offered_qos import read_qos_overrides
    from arm_cli.bag_format.reader import BagReader, warn_if_unfinished

    names = _remapped_names(options.remap)
    overrides = read_qos_overrides(options.qos_profile_overrides_path)
    with BagReader(options.bag_path) as reader:
        warn_if_unfinished(reader, "arm bag play")
        topics = _topics(reader, options)
        extent_ns = _extent(reader, options)
        with connect(NODE_NAME) as session:
            from arm_cli.bag.ros_player import BagPlayer

            player = BagPlayer(session, options.clock)
            try:
                playable = player.advertise(topics, names, overrides)
                if topics and not playable:
                    raise BagError(f"nothing of {reader.path} can be played")
                while True:
                    session.spin_for(options.delay)
                    _play_once(player, reader, playable, extent_ns, options)
                    if not options.loop:
                        break
                player.finish()
            except StoppedError:
                complain("Playing stopped")


def _play_once(
    player: "BagPlayer",
    reader: "BagReader",
    topics: list[str],
    extent_ns: tuple[int, int],
    options: argparse.Namespace,
) -> None:
    from arm_cli.bag.ros_player import PlaySchedule, ReadAhead

    start_ns, end_ns = extent_ns
    found = reader.messages(topics, start_ns)
    with ReadAhead(found, options.read_ahead_queue_size) as messages:
        schedule = PlaySchedule(start_ns, time.monotonic(), options.rate)
        # The time after the last message matters only to readers of /clock and to loops.
        to_the_end = options.loop or options.clock is not None
        player.play(messages, schedule, end_ns, to_the_end=to_the_end)


def _extent(reader: "BagReader", options: argparse.Namespace) -> tuple[int, int]:
    """Return the start and the end of playing, in the bag's time."""
    span = reader.metadata.span
    if span.start_ns is None or span.end_ns is None:
        raise BagError(f"{reader.path} has no messages")
    start_ns = span.start_ns + round(options.start_offset * 1e9)
    if start_ns > span.end_ns:
        raise BagError(
            f"--start-offset {options.start_offset:g} is beyond the end of {reader.path}, "
            f"which lasts {span.duration_ns * 1e-9:.3f} s"
        )
    end_ns = min(float(span.end_ns), start_ns + options.playback_duration * 1e9)
    return start_ns, round(end_ns)


def _topics(reader: "BagReader", options: argparse.Namespace) -> list["RecordedTopic"]:
    from arm_cli.bag.topic_selection import TopicSelection, absolute_names, compile_pattern

    wanted = absolute_names(options.topics)
    known = [topic.name for topic in reader.topics]
    for name in sorted(wanted.difference(known)):
        hint = describe_known(name, known, "it has")
        raise NoSuchNameError(f"no topic {name!r} in {reader.path}; {hint}")
    pattern = compile_pattern(options.regex, "--regex")
    selection = TopicSelection(
        every=not wanted and pattern is None,
        names=wanted,
        pattern=pattern,
        excluded_names=absolute_names(options.exclude_topics),
        excluded_pattern=compile_pattern(options.exclude_regex, "--exclude-regex"),
        hidden=True,
    )
    topics = [one for one in reader.recorded_topics if selection.wants(one.topic.name)]
    if known and not topics:
        raise BagError(
            f"no topic of {reader.path} is selected; it has {', '.join(known) or 'none'}"
        )
    reader.check_topics({one.topic.name for one in topics})
    return topics


def _remapped_names(words: list[str]) -> dict[str, str]:
    names: dict[str, str] = {}
    for word in words:
        old, separator, new = word.partition(":=")
        if not (old and separator and new):
            raise CommandUsageError(f"--remap {word!r} is not OLD:=NEW")
        names[absolute_name(old)] = absolute_name(new)
    return names
