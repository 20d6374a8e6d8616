"""Studies on a real cluster: two nodes of Ray on this machine, each with an address of its own."""

import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from pathlib import Path

import psutil
import pytest

from arm_gazebo.recording.replay import Replay
from arm_gazebo.recording.run_file import RunFile

pytestmark = [pytest.mark.slow, pytest.mark.timeout(600)]

TASK = """
import os, time
from pathlib import Path

HERE = Path(__file__).parent

def hold(run):
    folder, number, node = Path(run.values["folder"]), run.number, os.environ["NODE"]
    begun = folder / "begun.txt"
    with begun.open("a") as file:
        file.write(f"{number} {node}\\n")
    while node == "second" or (number == 3 and not (folder / "go").exists()):
        time.sleep(0.01)
    while run.values["both"] and "second" not in begun.read_text():
        time.sleep(0.01)
    if number == 1 and run.values["both"]:
        sim = run.simulation((HERE / "robot.urdf").read_text())
        sim.run(0.1)
        raise RuntimeError("it fell")
    return {"square": number ** 2}
"""
STUDY = "task: task.py:hold\nvariations: {{x: [1, 2, 3, 4, 5, 6], folder: [{}], both: [{}]}}\n"
URDF = """<robot name="stick"><link name="base"><inertial><mass value="1"/>
<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link></robot>"""

# A node whose Python has no arm_sim while a file exists.
HIDING = """
import os, sys

class WithoutTheSuite:
    def find_spec(self, name, path=None, target=None):
        if name == "arm_sim" and os.path.exists(os.environ["HIDE"]):
            raise ModuleNotFoundError("No module named 'arm_sim'", name="arm_sim")

sys.meta_path.insert(0, WithoutTheSuite())
"""
# Nodes that notice after a second and a half, not half a minute, that another has died, and that
# start no processes in advance, which these studies would not use.
QUICK = {
    "RAY_enable_worker_prestart": "0",
    "RAY_prestart_worker_first_driver": "0",
    "RAY_health_check_period_ms": "500",
    "RAY_health_check_failure_threshold": "3",
    "RAY_health_check_initial_delay_ms": "0",
}


class Cluster:
    """A head, and nodes that come and go; each has one processor.

    Attributes:
        address: of the head.
        hide: while this file exists, processes of the head that start do not find the suite.
    """

    def __init__(self, folder: Path) -> None:
        self.hide = folder / "hide"
        (folder / "sitecustomize.py").write_text(HIDING)
        self._environment = {
            **{name: value for name, value in os.environ.items() if not name.startswith("RAY_")},
            "RAY_USAGE_STATS_ENABLED": "0",
            "HIDE": str(self.hide),
            "PYTHONPATH": str(folder),
            **QUICK,
        }
        self._nodes: dict[str, subprocess.Popen[str]] = {}
        # Port 0 is any that is free. The path of a socket may have 107 bytes.
        head = ("--head", "--port", "0", "--include-dashboard", "false", "--temp-dir", str(folder))
        log = self._start("first", "127.0.0.2", head)
        found = re.search(r"--address='([\d.:]+)'", log)
        assert found, log
        self.address = found[1]

    def add(self, name: str, ip: str) -> None:
        self._start(name, ip, ("--address", self.address))

    def _start(self, name: str, ip: str, words: tuple[str, ...]) -> str:
        """Start a node and wait for it; return what it prints until then."""
        command = [
            *(sys.executable, "-m", "ray.scripts.scripts", "start", "--block", *words),
            *("--node-ip-address", ip, "--num-cpus", "1", "--object-store-memory", "80000000"),
            *("--disable-usage-stats", "--include-log-monitor", "false"),
        ]
        self._nodes[name] = process = subprocess.Popen(
            command,
            env={**self._environment, "NODE": name},
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            start_new_session=True,
        )
        assert process.stdout is not None
        log = ""
        while "To terminate the Ray runtime" not in log:
            line = process.stdout.readline()
            assert line, log
            log += line
        return log

    def kill(self, name: str) -> None:
        """Kill all processes of a node at once."""
        node = self._nodes.pop(name)
        for pid in psutil.pids():
            with suppress(ProcessLookupError):
                if os.getsid(pid) == node.pid:
                    os.kill(pid, signal.SIGKILL)
        node.communicate()

    def close(self) -> None:
        for name in list(self._nodes):
            self.kill(name)


@pytest.fixture(scope="module")
def cluster() -> Iterator[Cluster]:
    folder = Path(tempfile.mkdtemp(prefix="ray"))
    cluster = None
    try:
        cluster = Cluster(folder)
        yield cluster
    finally:
        if cluster:
            cluster.close()
        shutil.rmtree(folder, ignore_errors=True)


@pytest.fixture
def start(cluster, tmp_path) -> Iterator[Callable[..., subprocess.Popen[str]]]:
    """Start `arm sweep` for a study on the cluster; its process runs the Python `before` first."""
    (tmp_path / "study").mkdir()
    (tmp_path / "study/task.py").write_text(TASK)
    (tmp_path / "study/robot.urdf").write_text(URDF)
    started = []

    def start(
        before: str = "", both: bool = False, output: str = "study/out"
    ) -> subprocess.Popen[str]:
        study = STUDY.format(tmp_path, str(both).lower())
        (tmp_path / "study/study.yaml").write_text(study)
        words = ["sweep", "study/study.yaml", "--ray", cluster.address, "--output", output]
        program = f"import sys\n{before}\nfrom arm_cli.main import main\nsys.exit(main({words!r}))"
        process = subprocess.Popen(
            [sys.executable, "-c", program],
            cwd=tmp_path,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        started.append(process)
        return process

    yield start
    for process in started:
        process.kill()
        process.communicate()


def await_begun(folder: Path, run: str, process: subprocess.Popen[str]) -> None:
    """Wait until a line of begun.txt matches."""
    while not re.search(run, text(folder / "begun.txt"), re.MULTILINE):
        assert process.poll() is None, process.communicate()
        time.sleep(0.02)


def text(path: Path) -> str:
    return path.read_text() if path.exists() else ""


def journal(folder: Path) -> list[Mapping[str, object]]:
    lines = (folder / "study/out/runs.jsonl").read_text().splitlines()
    return [json.loads(line) for line in lines[1:]]


def begun(folder: Path) -> Counter[int]:
    """How often each run has begun."""
    lines = (folder / "begun.txt").read_text().splitlines()
    return Counter(int(line.split()[0]) for line in lines)


def test_a_node_that_joins_gets_runs_and_its_death_loses_none(cluster, start, tmp_path):
    (tmp_path / "go").touch()
    process = start(both=True)
    await_begun(tmp_path, "first$", process)
    cluster.add("second", "127.0.0.3")
    try:
        await_begun(tmp_path, "second$", process)
    finally:
        cluster.kill("second")
    output, errors = process.communicate()
    assert (process.returncode, "1 of 6 runs failed" in errors) == (1, True), (output, errors)
    outcomes = sorted(journal(tmp_path), key=lambda outcome: outcome["number"])
    assert [outcome["number"] for outcome in outcomes] == list(range(6))
    results = [outcome["results"] for outcome in outcomes]
    assert results == [{"square": n**2} if n != 1 else {} for n in range(6)]
    (lost,) = re.findall(r"(\d+) second\n", text(tmp_path / "begun.txt"))
    # The run that fails is repeated with a recording.
    assert begun(tmp_path) == Counter([*range(6), int(lost), 1])
    recording = tmp_path / "study/out/run_1.run"
    assert outcomes[1]["error"].startswith("RuntimeError: it fell (task.py:")
    assert outcomes[1]["replay"] == f"arm sim replay {recording}"
    assert Replay(RunFile(recording)).run().time_s == pytest.approx(0.1)


def test_after_ctrl_c_the_study_goes_on(start, tmp_path):
    process = start()
    await_begun(tmp_path, "^3 ", process)
    # The only processor is taken: another study does not wait for ever.
    other = start(
        before="from arm_sim.sweep import ray_pool\nray_pool.PATIENCE_S = 0.5", output="b"
    )
    output, errors = other.communicate()
    assert other.returncode == 1, output
    assert "has started no process within 0.5 s: its processors are busy; `ray status" in errors
    process.send_signal(signal.SIGINT)
    output, errors = process.communicate()
    assert (process.returncode, errors) == (signal.SIGINT, ""), output
    assert [outcome["number"] for outcome in journal(tmp_path)] == [0, 1, 2]
    (tmp_path / "go").touch()
    process = start()
    output, errors = process.communicate()
    assert (process.returncode, errors) == (0, ""), output
    assert "3 of 6 runs are already done" in output
    assert [outcome["number"] for outcome in journal(tmp_path)] == list(range(6))
    assert begun(tmp_path) == Counter([*range(6), 3])


OTHER_SUITE = """
from pathlib import Path
info = Path("older/arm_suite-0.0.1.dist-info")
info.mkdir(parents=True)
(info / "METADATA").write_text("Metadata-Version: 2.1\\nName: arm-suite\\nVersion: 0.0.1\\n")
sys.path.insert(0, "older")
"""


def test_another_version_of_the_suite_on_the_cluster_is_a_sentence(start):
    process = start(before=OTHER_SUITE)
    output, errors = process.communicate()
    assert process.returncode == 1, output
    assert errors.startswith(
        "arm sweep: 127.0.0.2 of the Ray cluster has other versions: arm-suite"
    )
    assert errors.endswith("(here 0.0.1); install the same on all its machines\n")


def test_another_version_of_ray_on_the_cluster_is_a_sentence(start):
    process = start(before="import ray\nray.__version__ = '2.0.0'")
    output, errors = process.communicate()
    assert process.returncode == 1, output
    assert errors.startswith("arm sweep: cannot join the Ray cluster at 127.0.0.2:")
    assert "Version mismatch: The cluster was started with: Ray: " in errors
    assert errors.count("\n") == 1


def test_a_cluster_without_the_suite_is_a_sentence(cluster, start):
    cluster.hide.touch()
    try:
        process = start()
        output, errors = process.communicate()
    finally:
        cluster.hide.unlink()
    assert process.returncode == 1, output
    assert "cannot make runs: ModuleNotFoundError: No module named 'arm_sim'; install" in errors
    assert errors.count("\n") == 1


# The last one: it leaves no cluster.
def test_when_the_head_goes_the_study_ends_with_a_sentence(cluster, start, tmp_path):
    process = start(before="from arm_sim.sweep import ray_head\nray_head.PATIENCE_S = 2.0")
    await_begun(tmp_path, "^3 ", process)
    cluster.kill("first")
    output, errors = process.communicate()
    assert process.returncode == 1, output
    assert "has not answered for 2 s; the same command goes on when it is back\n" in errors
    assert [outcome["number"] for outcome in journal(tmp_path)] == [0, 1, 2]
