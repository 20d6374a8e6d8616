"""`arm sweep`: makes the runs of a study on all cores, or on a Ray cluster."""

import argparse
import os
from pathlib import Path
from typing import TYPE_CHECKING

from arm_cli.arguments import Argument, positive_whole_number, verb
from arm_cli.errors import ArmCliError
from arm_cli.output import complain, say
from arm_node.printable import printable

if TYPE_CHECKING:
    from arm_sim.sweep.journal import Journal, Outcome
    from arm_sim.sweep.pool import Pool
    from arm_sim.sweep.study import Study


@verb(
    Argument("study", type=Path, metavar="STUDY", help="a YAML or Python file"),
    Argument(
        "--processes",
        type=positive_whole_number,
        help="processes that make runs (default: one for each core)",
    ),
    Argument(
        "--ray",
        metavar="ADDRESS",
        help="make the runs on the Ray cluster whose head has this address: HOST:PORT, or auto for "
        "the cluster of this machine",
    ),
    Argument(
        "--output",
        type=Path,
        metavar="DIR",
        help="folder of the results; an interrupted study continues there "
        "(default: NAME-results beside STUDY, where NAME is its name without suffix)",
    ),
)
def sweep(options: argparse.Namespace) -> int:
    """Make the runs, write the tables; return 1 if a run has failed."""
    from arm_sim.errors import ArmSimError
    from arm_sim.sweep.journal import Journal, write_tables
    from arm_sim.sweep.study import read_study

    folder = options.output or options.study.with_name(f"{options.study.stem}-results")
    try:
        study = read_study(options.study)
        with Journal(folder, study) as journal:
            _make_runs(study, journal, options)
    except ArmSimError as error:
        raise ArmCliError(str(error)) from error
    for path in write_tables(folder, journal.outcomes.values()):
        say(str(path))
    failed = sum(bool(outcome.error) for outcome in journal.outcomes.values())
    if failed:
        complain(f"{failed} of {len(journal.outcomes)} runs failed; the tables say why")
    return 1 if failed else 0


def _make_runs(study: "Study", journal: "Journal", options: argparse.Namespace) -> None:
    """Make the runs that the journal lacks, with a progress bar."""
    from rich.console import Console
    from rich.progress import MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

    from arm_sim.sweep.engine import Engine

    pool = _pool(study, journal.folder, options)
    total, before = len(study.runs()), len(journal.outcomes)
    if before:
        say(f"{before} of {total} runs are already done; the others follow")
    columns = (TextColumn("{task.description}"), MofNCompleteColumn(), TimeRemainingColumn())
    # rich's shared console writes to the stdout that it found first, which may be another one.
    with Progress(*columns, console=Console()) as progress:
        bar = progress.add_task("runs", total=total, completed=before)

        def told(outcome: "Outcome") -> None:
            progress.advance(bar)
            if outcome.error:
                line = f"run {outcome.number} failed: {outcome.error}"
                progress.console.print(printable(line), markup=False)

        Engine(study, journal, pool, told).run()


def _pool(study: "Study", folder: Path, options: argparse.Namespace) -> "Pool":
    if options.ray is None:
        from arm_sim.sweep.pool import ProcessPool

        return ProcessPool(study, folder, options.processes or os.cpu_count() or 1)
    # Ray is an extra.
    from arm_sim.sweep.ray_pool import RayPool

    return RayPool(options.ray, study, folder, options.processes)
