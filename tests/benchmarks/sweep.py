"""What a study costs: the engine for each run, two processes beside one, memory of a process.

    python tests/benchmarks/sweep.py [--runs 60]

A run simulates one second of the 4-DOF arm in a simulation of its own.
"""

import argparse
import statistics
import tempfile
import time
from pathlib import Path

import harness
import psutil
from harness import Row

from arm_sim.sweep.engine import Engine
from arm_sim.sweep.journal import Journal, Outcome
from arm_sim.sweep.study import Study

TASK = """
import time
from arm_sim import Simulation

def second(run):
    began_s = time.perf_counter()
    with Simulation("arm", arguments={"camera": "none"}, seed=run.seed) as sim:
        sim["position_controller"].command([run.values["x"] / 100] * 4)
        sim.run(1.0)
    return {"task_s": time.perf_counter() - began_s}
"""


def made(study: Study, folder: Path, processes: int) -> tuple[float, list[Outcome], float]:
    """Return wall time from the first result to the last, outcomes, and memory of a process."""
    times_s: list[float] = []
    memory: list[float] = []

    def told(_outcome: Outcome) -> None:
        times_s.append(time.perf_counter())
        children = psutil.Process().children(recursive=True)
        memory.extend(child.memory_info().rss / 1e6 for child in children)

    with Journal(folder, study) as journal:
        Engine(study, journal, processes, told).run()
    wall_s = times_s[-1] - times_s[processes - 1]
    return wall_s, list(journal.outcomes.values()), max(memory)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=60)
    runs = parser.parse_args().runs
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "task.py").write_text(TASK)
        study = Study(f"{folder / 'task.py'}:second", {"x": tuple(range(runs))})
        one_s, outcomes, memory_mb = made(study, folder / "one", 1)
        two_s, _, _ = made(study, folder / "two", 2)
    task_s = statistics.median(float(outcome.results["task_s"]) for outcome in outcomes)
    each_s = one_s / (runs - 1)
    rate = (runs - 2) / two_s * each_s
    rows = [
        Row("a run of one simulated second, its start included", f"{task_s * 1e3:.0f} ms"),
        Row("the engine, for each run", f"{(each_s - task_s) * 1e3:.1f} ms", "10 ms"),
        Row("two processes, against one", f"{rate:.2f} times the runs", "1.8"),
        Row("memory of a process", f"{memory_mb:.0f} MB"),
    ]
    harness.print_table("Studies", rows)


if __name__ == "__main__":
    main()
