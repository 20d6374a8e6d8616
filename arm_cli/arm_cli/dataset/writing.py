"""The verbs of `arm dataset`: demonstrations are recorded, or taken from bags, and checked."""

import argparse
import math
import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from arm_cli.arguments import Argument, positive_number, positive_whole_number, verb
from arm_cli.bag.info import existing_path
from arm_cli.dataset.expert import EXPERT, OF_EXPERTS, show
from arm_cli.dataset.selection import TOPICS, DatasetOptions, choose_topics, dataset_options
from arm_cli.errors import ArmCliError, BagError, StoppedError
from arm_cli.output import complain, say
from arm_cli.ros.connection import connect

if TYPE_CHECKING:
    from arm_sim.dataset import DatasetWriter

UNNAMED = "arm"
ROBOT = Argument("--robot", metavar="NAME", help=f"name of the robot ({UNNAMED})")


@verb(
    Argument(
        "bags", nargs="+", type=existing_path, metavar="BAG", help="a bag; each is one episode"
    ),
    Argument("-o", "--output", required=True, type=Path, metavar="DIR", help="folder to create"),
    Argument(
        "--task", required=True, metavar="TEXT", help="what the demonstrations show, in words"
    ),
    ROBOT,
    TOPICS,
)
def convert(options: argparse.Namespace) -> None:
    """Write the dataset; errors as `write_dataset`."""
    robot = options.robot or UNNAMED
    write_dataset(options.bags, options.output, options.task, robot, dataset_options(options))


def write_dataset(
    bags: Sequence[Path], output: Path, task: str, robot: str, wanted: DatasetOptions
) -> None:
    """Write bags as the episodes of a dataset, and say how its rows use their messages.

    Raises:
        BagError: a bag cannot be read, or lacks something that a dataset needs.
        ArmCliError: the extra is not installed, or the dataset cannot be written.
    """
    from arm_sim.errors import ArmSimError

    try:
        from arm_sim.dataset import DatasetWriter, check_dataset

        with DatasetWriter(output, robot) as writer:
            for bag in bags:
                # All episodes of a dataset have the rate of the first one.
                wanted = replace(wanted, fps=_add_bag(writer, bag, task, wanted))
            writer.finish()
        faults = check_dataset(output)
    except ArmSimError as error:
        raise ArmCliError(str(error)) from error
    if faults:
        raise ArmCliError(f"{output} was written, but {faults[0]}")
    say(f"wrote {output}: {len(bags)} episodes")


def _add_bag(writer: "DatasetWriter", bag: Path, task: str, wanted: DatasetOptions) -> int:
    """Add a bag as an episode; return its rows per second."""
    from arm_cli.bag_format.reader import BagReader, warn_if_unfinished
    from arm_cli.dataset.ros_streams import EpisodeReader
    from arm_sim.dataset import align

    with BagReader(bag) as reader:
        warn_if_unfinished(reader, "arm dataset")
        chosen = choose_topics(wanted, dict(reader.metadata.topics))
        episode = EpisodeReader(reader, chosen, wanted)
        streams, reference = episode.streams()
        rows = align(streams, reference, wanted.fps)
        writer.add_episode(streams, rows, task, {"bag": bag.name})
    jitter_ms = rows.jitter_s * 1e3
    say(f"{bag}: {rows.length} rows at {rows.fps} Hz, off by up to {jitter_ms:.1f} ms")
    for line in (*episode.remarks, *map(str, rows.uses)):
        say(f"  {line}")
    return rows.fps


@verb(Argument("folder", type=Path, metavar="DIR", help="a dataset in LeRobot's format"))
def check(options: argparse.Namespace) -> int:
    """Print the faults of a dataset; return 1 if it has any."""
    from arm_sim.errors import ArmSimError

    try:
        from arm_sim.dataset import check_dataset

        faults = check_dataset(options.folder)
    except ArmSimError as error:
        raise BagError(str(error)) from error
    say(*(faults or [f"{options.folder} is valid in LeRobot's format v3.0"]))
    return 1 if faults else 0


CACHE_BYTES = 100 * 1024 * 1024
POLL_S = 0.1
NODE_NAME = "dataset_recorder"


@verb(
    Argument("output", type=Path, nargs="?", metavar="DIR", help="folder to create"),
    Argument("-o", "--output", dest="folder", type=Path, metavar="DIR", help="the same"),
    Argument(
        "-d",
        "--duration",
        type=positive_number,
        metavar="SECONDS",
        help="length of each episode (default: until Ctrl-C, which ends the last one)",
    ),
    Argument(
        "-n",
        "--episodes",
        type=positive_whole_number,
        default=1,
        metavar="N",
        help="episodes, one after the other (default 1); more need --duration",
    ),
    Argument("--task", metavar="TEXT", help="what the demonstrations show, in words"),
    ROBOT,
    TOPICS,
    EXPERT,
)
def record(options: argparse.Namespace) -> None:
    """Record a bag for each episode beside the dataset, then write the dataset."""
    if (options.output is None) == (options.folder is None):
        raise ArmCliError("record needs one folder: arm dataset record DIR")
    output = options.output or options.folder
    if options.expert is not None:
        show(options, output)
        return
    if options.task is None:
        raise ArmCliError("record needs --task: what the demonstrations show, in words")
    given = [f"--{name}" for name in OF_EXPERTS if getattr(options, name) is not None]
    if given:
        raise ArmCliError(f"{given[0]} is for --expert; a running robot is recorded without it")
    if options.episodes > 1 and options.duration is None:
        raise ArmCliError("several episodes need --duration")
    bags = output.with_name(f"{output.name}_bags")
    for folder in (output, bags):
        if folder.exists():
            raise ArmCliError(f"{folder} exists; choose a new folder")
    recorded = _record(bags, options.episodes, options.duration)
    robot = options.robot or UNNAMED
    write_dataset(recorded, output, options.task, robot, dataset_options(options))
    complain(f"the messages themselves are in {bags}")


def _after(duration_s: float | None) -> Callable[[], bool]:
    """Return a function that tells whether a time from now has passed; None for never."""
    end_s = math.inf if duration_s is None else time.monotonic() + duration_s
    return lambda: time.monotonic() >= end_s


def _record(folder: Path, episodes: int, duration_s: float | None) -> list[Path]:
    """Record all topics into a bag for each episode; a signal ends the last one."""
    from arm_cli.bag.ros_recorder import Recording
    from arm_cli.bag.topic_selection import TopicSelection
    from arm_cli.bag_format.writer import BagSettings, BagWriter
    from arm_cli.ros.graph import Graph

    recorded: list[Path] = []
    folder.mkdir(parents=True)
    with connect(NODE_NAME) as session:
        from arm_cli.bag.ros_recorder import BagRecorder

        # The first episode is as long as the others: no topic is found in the middle of it.
        Graph(session).settle()
        for number in range(episodes):
            path = folder / f"episode_{number:06d}"
            recording = Recording(BagWriter(path, BagSettings()), CACHE_BYTES)
            recorder = BagRecorder(session, recording, TopicSelection(every=True), POLL_S, False)
            complain(f"Episode {number + 1} of {episodes}")
            stopped = False
            try:
                recorder.run(ended=_after(duration_s))
            except StoppedError:
                stopped = True
            recording.finish()
            recorder.close()
            for topic, count in sorted((recording.dropped + recorder.lost).items()):
                complain(f"{count} messages of {topic} were lost")
            recorded.append(path)
            if stopped:
                break
    return recorded
