"""What a study costs: the engine for each run, two processes beside one, memory of a process.

    python benchmarks/sweep.py [--runs 60] [--ray ADDRESS]

A run simulates one second of the 4-DOF arm in a simulation of its own. With a Ray cluster, as
`ray start --head` starts one on this machine, the same runs are made there, too.
"""

import argparse
import itertools
import statistics
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import harness
import psutil
from harness import Row

from arm_sim.sweep.engine import Engine
from arm_sim.sweep.journal import FILE_NAME, Journal, Outcome, write_tables
from arm_sim.sweep.pool import Pool, ProcessPool
from arm_sim.sweep.study import Study

TASK = """
import time
from pathlib import Path
from arm_sim import Simulation

def second(run):
    began_s = time.perf_counter()
    with Simulation("arm", arguments={"camera": "none"}, seed=run.seed) as sim:
        sim["position_controller"].command([run.values["x"] / 100] * 4)
        sim.run(1.0)
    memory = Path("/proc/self/status").read_text().partition("VmRSS:")[2].split()[0]
    return {"memory_mb": int(memory) / 1e3, "task_s": time.perf_counter() - began_s}

def nothing(run):
    return {"memory_mb": 0.0, "task_s": 0.0}
"""
EMPTY_RUNS = 3000
NOTED = 100_000


@dataclass(frozen=True)
class Made:
    """What making the runs of a study cost, without the first runs, which start the processes.

    Attributes:
        each_s: mean wall time of a run and the engine.
        task_s: mean wall time that a run took in its process.
        owner_s: mean processor time of this process for each run.
        memory_mb: largest resident memory of a process that makes runs.
    """

    each_s: float
    task_s: float
    owner_s: float
    memory_mb: float


def made(study: Study, folder: Path, pool: Pool, workers: int) -> Made:
    """Make the runs of a study."""
    seen: list[tuple[float, float, Outcome]] = []

    def told(outcome: Outcome) -> None:
        seen.append((time.perf_counter(), time.process_time(), outcome))

    with Journal(folder, study) as journal:
        Engine(study, journal, pool, told).run()
    (begin_s, owner_begin_s, _), *rest = seen[2 * workers :]
    outcomes = [outcome for _, _, outcome in rest]
    return Made(
        (rest[-1][0] - begin_s) / len(rest),
        statistics.mean(float(outcome.results["task_s"]) for outcome in outcomes),
        (rest[-1][1] - owner_begin_s) / len(rest),
        max(float(outcome.results["memory_mb"]) for outcome in outcomes),
    )


def journal_rows(folder: Path) -> list[Row]:
    """Return what it costs to keep many outcomes."""
    study = Study(f"{folder / 'task.py'}:nothing", {"x": tuple(range(NOTED))})
    process = psutil.Process()
    before_mb = process.memory_info().rss / 1e6
    with Journal(folder / "noted", study) as journal:
        began_s = time.process_time()
        for number, values in enumerate(study.runs()):
            journal.add(Outcome(number, values, {"error_rad": number / 7, "task_s": number / 3}))
        noted_s = time.process_time() - began_s
    size_mb = (folder / "noted" / FILE_NAME).stat().st_size / 1e6
    began_s = time.process_time()
    write_tables(folder / "noted", journal.outcomes.values())
    tables_s = time.process_time() - began_s
    memory_mb = process.memory_info().rss / 1e6 - before_mb
    return [
        Row("noting an outcome, processor time", f"{noted_s / NOTED * 1e6:.0f} us"),
        Row("the tables, processor time for 100 000 runs", f"{tables_s:.1f} s"),
        Row(
            "the journal of 100 000 runs; memory of its owner", f"{size_mb:.0f}; {memory_mb:.0f} MB"
        ),
    ]


def rows_of(
    where: str, of: Callable[[Study, Path, int], Pool], folder: Path, runs: int
) -> list[Row]:
    """Return the figures of one kind of pool; `of` makes one of a size."""
    numbers = itertools.count()

    def measure(task: str, count: int, workers: int) -> Made:
        study = Study(f"{folder / 'task.py'}:{task}", {"x": tuple(range(count))})
        results = folder / f"{where}{next(numbers)}"
        return made(study, results, of(study, results, workers), workers)

    # In turn, so that both meet the same load.
    pairs = [(measure("second", runs, 1), measure("second", runs, 2)) for _ in range(3)]
    one = [pair[0] for pair in pairs]
    empty = measure("nothing", EMPTY_RUNS, 1)
    rate = statistics.median(one.each_s / two.each_s for one, two in pairs)
    engine_s = statistics.median(made.each_s - made.task_s for made in one)
    rows = [
        Row(
            "a run, its start included", f"{statistics.median(m.task_s for m in one) * 1e3:.0f} ms"
        ),
        Row("the engine, for each run", f"{engine_s * 1e3:.1f} ms", "10 ms"),
        Row("an empty run, one after the other", f"{empty.each_s * 1e3:.2f} ms"),
        Row("of it, processor time of the owner", f"{empty.owner_s * 1e3:.2f} ms"),
        Row("two processes, against one", f"{rate:.2f} times the runs", "1.8"),
    ]
    memory_mb = max(made.memory_mb for pair in pairs for made in pair)
    rows.append(Row("memory of a process that makes runs", f"{memory_mb:.0f} MB"))
    return [Row(f"{where}: {row.what}", row.measured, row.target) for row in rows]


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=60)
    parser.add_argument("--ray", metavar="ADDRESS")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "task.py").write_text(TASK)
        rows = rows_of("processes", ProcessPool, folder, options.runs)
        if options.ray:
            from arm_sim.sweep.ray_pool import RayPool

            def ray_pool(study: Study, results: Path, size: int) -> Pool:
                return RayPool(options.ray, study, results, size)

            rows += rows_of("Ray", ray_pool, folder, options.runs)
        rows += journal_rows(folder)
    harness.print_table("Studies", rows)


if __name__ == "__main__":
    main()
