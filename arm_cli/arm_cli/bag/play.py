"""`arm bag play`: publish again what is in a bag."""

import argparse
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING

from arm_cli.bag.bag_path import existing_path
from arm_cli.command_parser import positive_number, positive_number_or_zero, positive_whole_number
from arm_cli.errors import BagError, NotFoundError, StoppedError, UsageError
from arm_cli.names import absolute_name
from arm_cli.ros.connection import connect
from launch_py.near_names import describe_known

if TYPE_CHECKING:
    from arm_cli.bag.bag_reader import BagReader
    from arm_cli.bag.bag_topic import BagTopic
    from arm_cli.ros.bag_player import BagPlayer

CLOCK_HZ = 40.0
READ_AHEAD = 1000
NODE_NAME = "rosbag2_player"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    parser.add_argument("bag_path", type=existing_path, help="folder of a bag, or an .mcap file")
    parser.add_argument("-s", "--storage", choices=("mcap",), default="mcap", help="its format")
    _add_topics(parser)
    parser.add_argument(
        "-r", "--rate", type=positive_number, default=1.0, help="how fast to play (default 1.0)"
    )
    parser.add_argument("-l", "--loop", action="store_true", help="begin anew at the end")
    parser.add_argument(
        "--start-offset",
        type=positive_number_or_zero,
        default=0.0,
        metavar="SECONDS",
        help="leave out so much of the beginning",
    )
    parser.add_argument(
        "--playback-duration",
        type=_duration,
        default=float("inf"),
        metavar="SECONDS",
        help="play only so much of the bag; a negative number: all",
    )
    parser.add_argument(
        "--clock",
        type=positive_number,
        nargs="?",
        const=CLOCK_HZ,
        metavar="HZ",
        help=f"publish the bag's time on /clock (without a rate {CLOCK_HZ:g} Hz)",
    )
    parser.add_argument(
        "-d",
        "--delay",
        type=positive_number_or_zero,
        default=0.0,
        metavar="SECONDS",
        help="wait so long before each time it is played",
    )
    parser.add_argument(
        "--read-ahead-queue-size",
        type=positive_whole_number,
        default=READ_AHEAD,
        metavar="N",
        help=f"messages that are read before they are due (default {READ_AHEAD})",
    )
    parser.add_argument(
        "--qos-profile-overrides-path",
        type=Path,
        metavar="FILE",
        help="YAML with the quality of service of publishers, by topic",
    )
    # There are no such controls; but lines written for ros2 switch them off.
    parser.add_argument("--disable-keyboard-controls", action="store_true", help=argparse.SUPPRESS)


def _add_topics(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("topics", "By default: all.")
    group.add_argument("--topics", nargs="+", metavar="TOPIC", help="play only these")
    group.add_argument("-e", "--regex", metavar="REGEX", help="play those in which it is found")
    group.add_argument("--exclude-topics", nargs="+", metavar="TOPIC", help="but not these")
    group.add_argument(
        "-x", "--exclude-regex", metavar="REGEX", help="but none in which it is found"
    )
    group.add_argument(
        "-m",
        "--remap",
        nargs="+",
        default=[],
        metavar="OLD:=NEW",
        help="publish topics under other names",
    )


def _duration(text: str) -> float:
    # rosbag2's own default is -1.
    duration_s = positive_number(text.removeprefix("-"))
    return float("inf") if text.startswith("-") else duration_s


def run(options: argparse.Namespace) -> None:
    """Play until the end, or until a signal comes.

    Raises:
        NotFoundError: the bag has no such topic.
        BagError: the bag or the file of overrides cannot be read, or there is nothing to play.
        UsageError: a name to be remapped is not OLD:=NEW.
    """
    from arm_cli.bag.bag_reader import BagReader, describe_unfinished
    from arm_cli.bag.qos_overrides import read_qos_overrides

    names = _remapped_names(options.remap)
    overrides = read_qos_overrides(options.qos_profile_overrides_path)
    with BagReader(options.bag_path) as reader:
        unfinished = describe_unfinished(reader)
        if unfinished is not None:
            print(f"arm bag play: {unfinished}", file=sys.stderr)
        topics = _topics(reader, options)
        extent_ns = _extent(reader, options)
        with connect(NODE_NAME) as session:
            from arm_cli.ros.bag_player import BagPlayer

            player = BagPlayer(session, options.clock)
            try:
                playable = player.advertise(topics, names, overrides)
                while True:
                    session.spin_for(options.delay)
                    _play_once(player, reader, playable, extent_ns, options)
                    if not options.loop:
                        break
                player.finish()
            except StoppedError:
                print("Playing stopped", file=sys.stderr)


def _play_once(
    player: "BagPlayer",
    reader: "BagReader",
    topics: list[str],
    extent_ns: tuple[int, int],
    options: argparse.Namespace,
) -> None:
    from arm_cli.bag.play_schedule import PlaySchedule
    from arm_cli.bag.read_ahead import ReadAhead

    start_ns, end_ns = extent_ns
    found = reader.messages(topics, start_ns)
    with ReadAhead(found, options.read_ahead_queue_size) as messages:
        schedule = PlaySchedule(start_ns, time.monotonic(), options.rate)
        # The rest of the bag matters to who goes by its clock, and to the period of a loop only.
        to_the_end = options.loop or options.clock is not None
        player.play(messages, schedule, end_ns, to_the_end=to_the_end)


def _extent(reader: "BagReader", options: argparse.Namespace) -> tuple[int, int]:
    """Return the times of the bag between which it is played."""
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


def _topics(reader: "BagReader", options: argparse.Namespace) -> list["BagTopic"]:
    from arm_cli.bag.topic_selection import TopicSelection, absolute_names, compile_pattern

    wanted = absolute_names(options.topics)
    known = [topic.name for topic in reader.topics]
    for name in sorted(wanted.difference(known)):
        hint = describe_known(name, known, "it has")
        raise NotFoundError(f"no topic {name!r} in {reader.path}; {hint}")
    pattern = compile_pattern(options.regex, "--regex")
    selection = TopicSelection(
        every=not wanted and pattern is None,
        names=wanted,
        pattern=pattern,
        excluded_names=absolute_names(options.exclude_topics),
        excluded_pattern=compile_pattern(options.exclude_regex, "--exclude-regex"),
        hidden=True,
    )
    topics = [topic for topic in reader.topics if selection.wants(topic.name)]
    if known and not topics:
        raise BagError(
            f"no topic of {reader.path} is selected; it has {', '.join(known) or 'none'}"
        )
    return topics


def _remapped_names(words: list[str]) -> dict[str, str]:
    names: dict[str, str] = {}
    for word in words:
        old, separator, new = word.partition(":=")
        if not (old and separator and new):
            raise UsageError(f"--remap {word!r} is not OLD:=NEW")
        names[absolute_name(old)] = absolute_name(new)
    return names
