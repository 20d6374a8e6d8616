"""The verbs of `arm dataset`: demonstrations are recorded, or taken from bags, and checked.

An expert demonstrates its task in simulations of its own.
"""

import argparse
import math
import os
import signal
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from types import FrameType
from typing import TYPE_CHECKING

from arm_cli.arguments import (
    Argument,
    Group,
    positive_number,
    positive_whole_number,
    verb,
    whole_number,
)
from arm_cli.bag.info import existing_path
from arm_cli.dataset.selection import TOPICS, DatasetOptions, choose_topics, dataset_options
from arm_cli.errors import ArmCliError, BagError, StoppedError
from arm_cli.output import complain, say
from arm_cli.ros.connection import connect

if TYPE_CHECKING:
    from arm_sim.dataset import DatasetWriter
    from arm_sim.demonstrations.recording import Making

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

EXPERTS = ("pick",)
OF_EXPERTS = ("seed", "workers", "ray")
"""The options that a recording of a running robot does not have."""
OF_RECORDINGS = ("duration", "state", "action", "cameras", "fps")
"""The options that an expert does not have."""
ENDING = b"ends after this episode with those so far; Ctrl-C again discards all of them\n"

EXPERT = Group(
    "experts",
    Argument(
        "--expert",
        choices=EXPERTS,
        help="instead of recording a running robot, let an expert demonstrate its task in random "
        "scenes; pick: the myCobot lifts a cylinder",
    ),
    Argument(
        "--seed",
        type=whole_number,
        metavar="N",
        help="seed of the first episode (default 0); each further one has the next",
    ),
    Argument(
        "--workers",
        type=positive_whole_number,
        metavar="N",
        help="processes that make episodes (default: one for each core)",
    ),
    Argument(
        "--ray",
        metavar="ADDRESS",
        help="make the episodes on the Ray cluster whose head has this address: HOST:PORT, or auto "
        "for the cluster of this machine",
    ),
)
"""The options of experts."""


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
        _demonstrate(options, output)
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


def _demonstrate(options: argparse.Namespace, output: Path) -> None:
    """Let an expert make a dataset; say in which episodes it failed.

    Raises:
        ArmCliError: an option does not fit, an extra is not installed, or the dataset cannot be
            written.
    """
    given = [f"--{name}" for name in OF_RECORDINGS if getattr(options, name) is not None]
    if given:
        raise ArmCliError(f"{given[0]} is for the recording of a running robot, not for --expert")
    from arm_sim.errors import ArmSimError

    words = {"task": options.task, "robot": options.robot}
    try:
        from arm_sim.demonstrations import record_demonstrations

        with _ctrl_c() as was_pressed, _workers(options) as (start, workers):
            recorded = record_demonstrations(
                output,
                options.episodes,
                start,
                seed=options.seed or 0,
                # One more than there are workers, so that none waits for the writing.
                ahead=workers + 1,
                say=complain,
                enough=was_pressed,
                **{name: text for name, text in words.items() if text is not None},
            )
    except (ArmSimError, OSError) as error:
        raise ArmCliError(str(error)) from error
    say(
        f"wrote {output}: {recorded.episodes} episodes, each in {recorded.processor_s:.1f} s of "
        "processor time"
    )
    if recorded.failures:
        tried = recorded.episodes + len(recorded.failures)
        seeds = ", ".join(map(str, recorded.failures))
        say(f"the expert failed in {len(recorded.failures)} of {tried}, left out: seeds {seeds}")


@contextmanager
def _ctrl_c() -> Iterator[Callable[[], bool]]:
    """Give whether Ctrl-C was pressed; pressed again, it interrupts at once."""
    pressed = False

    def note(number: int, frame: FrameType | None) -> None:
        nonlocal pressed
        if pressed:
            signal.default_int_handler(number, frame)
        pressed = True
        # Not by `print`, which this may have interrupted.
        os.write(2, ENDING)

    before = signal.getsignal(signal.SIGINT)
    if before is not signal.SIG_IGN:
        signal.signal(signal.SIGINT, note)
    try:
        yield lambda: pressed
    finally:
        signal.signal(signal.SIGINT, before)


@contextmanager
def _workers(options: argparse.Namespace) -> "Iterator[tuple[Making, int]]":
    """Give what starts episodes, and how many it makes at once."""
    if options.ray is not None:
        from arm_sim.demonstrations.ray_workers import ray_workers

        with ray_workers(options.ray, options.workers) as started:
            yield started
        return
    from arm_sim.demonstrations import worker_processes

    number = options.workers or len(os.sched_getaffinity(0))
    with worker_processes(number) as start:
        yield start, number
