import csv
import multiprocessing
import signal
import subprocess
import sys

import pyarrow.parquet
import pytest

from arm_gazebo.recording.replay import Replay
from arm_gazebo.recording.run_file import RunFile
from arm_sim.sweep.engine import Engine
from arm_sim.sweep.journal import FILE_NAME, Journal, Outcome, write_tables
from arm_sim.sweep.pool import ProcessPool
from arm_sim.sweep.study import Study, StudyError

TASK = """
import os, signal, time
from pathlib import Path

HERE = Path(__file__).parent

def square(run):
    with (HERE / "made.txt").open("a") as file:
        file.write(f"{run.number}\\n")
    return {"square": run.values["x"] ** 2, "seed": run.seed}

def sometimes(run):
    x = run.values["x"]
    if x == 1:
        raise ValueError("x is 1")
    if x == 2:
        os.kill(os.getpid(), signal.SIGKILL)
    if x == 3:
        time.sleep(100.0)
    if x == 4:
        return {"bad": float("nan")}
    return {"fine": True}

def killed_once(run):
    mark = HERE / f"mark{run.number}"
    if not mark.exists():
        mark.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return {"fine": True}

def wait_for_end_of_owner(run):
    owner = os.getppid()
    os.kill(owner, signal.SIGKILL)
    while os.getppid() == owner:
        time.sleep(0.01)
    return {}

def reach(run):
    sim = run.simulation("arm", arguments={"camera": "none"})
    sim["position_controller"].command([run.values["x"]] * 4)
    sim.run(0.5)
    if run.values["x"] > 0.2:
        raise RuntimeError("too far")
    return {"j0": sim.joints["j0"].position}
"""


@pytest.fixture
def study(tmp_path):
    (tmp_path / "task.py").write_text(TASK)

    def make(function: str, xs, **more) -> Study:
        return Study(f"{tmp_path / 'task.py'}:{function}", {"x": tuple(xs)}, **more)

    return make


def made(study: Study, folder, processes: int = 1):
    """Make the runs; return the outcomes by number."""
    with Journal(folder, study) as journal:
        Engine(study, journal, ProcessPool(study, folder, processes)).run()
    return journal.outcomes


def test_every_run_is_made_once_and_has_a_seed_of_its_own(study, tmp_path):
    outcomes = made(study("square", range(20)), tmp_path / "out", processes=2)
    assert {n: o.results["square"] for n, o in outcomes.items()} == {n: n**2 for n in range(20)}
    assert len({o.results["seed"] for o in outcomes.values()}) == 20
    assert sorted(map(int, (tmp_path / "made.txt").read_text().split())) == list(range(20))


@pytest.mark.parametrize("cut", [20, -1], ids=["in the last line", "before its end"])
def test_an_interrupted_study_goes_on_without_losing_or_repeating_a_run(study, tmp_path, cut):
    xs = study("square", range(6))
    with Journal(tmp_path / "out", xs) as journal:
        for number in range(4):
            journal.add(Outcome(number, {"x": number}, {"square": number**2}))
    path = tmp_path / "out" / FILE_NAME
    # As after a kill: the last line is not whole.
    *whole, last = path.read_text().splitlines(keepends=True)
    path.write_text("".join([*whole, last[:cut]]))
    outcomes = made(xs, tmp_path / "out")
    assert sorted(outcomes) == list(range(6))
    assert sorted(map(int, (tmp_path / "made.txt").read_text().split())) == [3, 4, 5]
    with Journal(tmp_path / "out", xs) as journal:
        assert sorted(journal.outcomes) == list(range(6))


def test_failures_have_their_reason(study, tmp_path):
    outcomes = made(study("sometimes", [0, 1, 2, 4, 5]), tmp_path / "out")
    assert outcomes[0].results == {"fine": True}
    assert outcomes[4].error == ""
    assert outcomes[1].error.startswith("ValueError: x is 1 (task.py:")
    assert outcomes[2].error == "its process ended with exit code -9"
    assert "result 'bad' is nan, which is not a finite number" in outcomes[3].error


def test_a_run_that_takes_too_long_has_failed_and_the_next_is_made(study, tmp_path):
    outcomes = made(study("sometimes", [3, 3], timeout_s=0.5), tmp_path / "out")
    assert [outcomes[n].error for n in range(2)] == ["it took more than 0.5 s"] * 2


def test_a_run_whose_process_is_killed_once_is_made_again(study, tmp_path):
    outcomes = made(study("killed_once", range(2)), tmp_path / "out")
    assert [outcomes[n].results for n in range(2)] == [{"fine": True}] * 2


def test_a_process_that_dies_between_two_runs_loses_neither(study, tmp_path):
    xs = study("square", range(3))
    killed = []
    others = set(multiprocessing.active_children())

    def kill_its_process(_outcome):
        # The process has sent its outcome and waits; the engine is about to give it the next run.
        if not killed:
            (process,) = set(multiprocessing.active_children()) - others
            process.kill()
            process.join()
            killed.append(process.pid)

    with Journal(tmp_path / "out", xs) as journal:
        Engine(xs, journal, ProcessPool(xs, journal.folder, 1), kill_its_process).run()
    assert killed
    assert {n: o.results["square"] for n, o in journal.outcomes.items()} == {0: 0, 1: 1, 2: 4}
    assert sorted(map(int, (tmp_path / "made.txt").read_text().split())) == [0, 1, 2]


def test_a_task_whose_import_ends_its_process_ends_the_study(tmp_path):
    xs = Study(f"{tmp_path / 'task.py'}:run", {"x": (1,)})
    (tmp_path / "task.py").write_text("import os\nos._exit(0)\n")
    with pytest.raises(StudyError, match="ended with exit code 0 before its first run"):
        made(xs, tmp_path / "out")
    (tmp_path / "task.py").write_text("import sys\nsys.exit(3)\n")
    with pytest.raises(StudyError, match="cannot be imported: SystemExit: 3"):
        made(xs, tmp_path / "out")


def test_processes_end_without_a_word_when_their_owner_is_killed(study, tmp_path):
    xs = study("wait_for_end_of_owner", [1])
    owner = """
import sys
from pathlib import Path
from arm_sim.sweep.engine import Engine
from arm_sim.sweep.journal import Journal
from arm_sim.sweep.pool import ProcessPool
from arm_sim.sweep.study import Study
if __name__ == "__main__":
    study = Study(sys.argv[1], {"x": (1,)})
    folder = Path(sys.argv[2])
    Engine(study, Journal(folder, study), ProcessPool(study, folder, 1)).run()
"""
    (tmp_path / "owner.py").write_text(owner)
    command = [sys.executable, tmp_path / "owner.py", xs.task, tmp_path / "out"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=100, check=False)
    assert (done.returncode, done.stderr) == (-signal.SIGKILL, "")


def test_a_failed_run_of_a_simulation_is_recorded_and_replays(study, tmp_path):
    outcomes = made(study("reach", [0.1, 0.3]), tmp_path / "out")
    assert outcomes[0].results["j0"] == pytest.approx(0.1, abs=0.01)
    recording = tmp_path / "out" / "run_1.run"
    assert outcomes[1].replay == f"arm sim replay {recording}"
    result = Replay(RunFile(recording)).run()
    assert result.difference is None
    assert result.time_s == pytest.approx(0.5)
    assert not (tmp_path / "out" / "run_0.run").exists()


def test_a_folder_of_another_study_is_refused(study, tmp_path):
    with Journal(tmp_path / "out", study("square", range(2))):
        pass
    with pytest.raises(StudyError, match="holds the runs of another study"):
        Journal(tmp_path / "out", study("square", range(3)))


def test_a_task_that_cannot_be_imported_ends_the_study(study, tmp_path):
    with pytest.raises(StudyError, match="has no function 'nothing'"):
        made(study("nothing", range(2)), tmp_path / "out")


def test_tables_have_a_row_for_each_run(tmp_path):
    failed = Outcome(1, {"x": 1}, {}, "ValueError: x is 1 (task.py:14)")
    paths = write_tables(tmp_path, [failed, Outcome(0, {"x": 0}, {"fine": True})])
    with paths[0].open() as file:
        rows = list(csv.DictReader(file))
    assert [row["run"] for row in rows] == ["0", "1"]
    assert rows[1]["error"].startswith("ValueError: x is 1")
    table = pyarrow.parquet.read_table(paths[1]).to_pydict()
    assert table["x"] == [0, 1]
    assert table["fine"] == [True, None]
