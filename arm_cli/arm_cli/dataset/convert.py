"""`arm dataset convert` and `arm dataset check`: bags to a dataset of demonstrations."""

import argparse
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from arm_cli.arguments import Argument, verb
from arm_cli.bag.info import existing_path
from arm_cli.dataset.selection import TOPICS, DatasetOptions, choose_topics, dataset_options
from arm_cli.errors import ArmCliError, BagError
from arm_cli.output import say

if TYPE_CHECKING:
    from arm_sim.dataset import DatasetWriter


DATASET = (
    Argument(
        "--task", required=True, metavar="TEXT", help="what the demonstrations show, in words"
    ),
    Argument("--robot", default="arm", metavar="NAME", help="name of the robot (arm)"),
    TOPICS,
)
"""The arguments of all verbs that write datasets."""


@verb(
    Argument(
        "bags", nargs="+", type=existing_path, metavar="BAG", help="a bag; each is one episode"
    ),
    Argument("-o", "--output", required=True, type=Path, metavar="DIR", help="folder to create"),
    *DATASET,
)
def convert(options: argparse.Namespace) -> None:
    """Write the dataset; errors as `write_dataset`."""
    write_dataset(
        options.bags, options.output, options.task, options.robot, dataset_options(options)
    )


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
    from arm_cli.bag.bag_reader import BagReader, warn_if_unfinished
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


@verb(
    Argument("folder", type=Path, metavar="DIR", help="a dataset in LeRobot's format"),
)
def check(options: argparse.Namespace) -> int:
    """Print the faults of a dataset; return 1 if it has any.

    Raises:
        BagError: the dataset cannot be read, or the extra is not installed.
    """
    from arm_sim.errors import ArmSimError

    try:
        from arm_sim.dataset import check_dataset

        faults = check_dataset(options.folder)
    except ArmSimError as error:
        raise BagError(str(error)) from error
    say(*(faults or [f"{options.folder} is valid in LeRobot's format v3.0"]))
    return 1 if faults else 0
