"""`arm dataset record`: records demonstrations, whoever commands the robot, and converts them."""

import argparse
import math
import time
from collections.abc import Callable
from pathlib import Path

from arm_cli.arguments import Argument, positive_number, positive_whole_number, verb
from arm_cli.dataset.convert import DATASET, write_dataset
from arm_cli.dataset.selection import dataset_options
from arm_cli.errors import ArmCliError, StoppedError
from arm_cli.output import complain
from arm_cli.ros.connection import connect

CACHE_BYTES = 100 * 1024 * 1024
POLL_S = 0.1
NODE_NAME = "dataset_recorder"


@verb(
    Argument("output", type=Path, metavar="DIR", help="folder to create"),
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
    *DATASET,
)
def run(options: argparse.Namespace) -> None:
    """Record a bag for each episode beside the dataset, then write the dataset.

    Raises:
        ArmCliError: the folder exists, or the recording is not a dataset.
    """
    if options.episodes > 1 and options.duration is None:
        raise ArmCliError("several episodes need --duration")
    bags = options.output.with_name(f"{options.output.name}_bags")
    for folder in (options.output, bags):
        if folder.exists():
            raise ArmCliError(f"{folder} exists; choose a new folder")
    recorded = _record(bags, options.episodes, options.duration)
    write_dataset(recorded, options.output, options.task, options.robot, dataset_options(options))
    complain(f"the messages themselves are in {bags}")


def _after(duration_s: float | None) -> Callable[[], bool]:
    """Return a function that tells whether a time from now has passed; None for never."""
    end_s = math.inf if duration_s is None else time.monotonic() + duration_s
    return lambda: time.monotonic() >= end_s


def _record(folder: Path, episodes: int, duration_s: float | None) -> list[Path]:
    """Record all topics into a bag for each episode; a signal ends the last one."""
    from arm_cli.bag.bag_writer import BagSettings, BagWriter
    from arm_cli.bag.recording import Recording
    from arm_cli.bag.topic_selection import TopicSelection

    recorded: list[Path] = []
    folder.mkdir(parents=True)
    with connect(NODE_NAME) as session:
        from arm_cli.bag.ros_recorder import BagRecorder

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
