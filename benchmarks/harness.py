"""Shared by the benchmark scripts: start the suite, watch it from outside, print a table.

Run any script of this folder with the Python that the suite is installed in. They measure whole
processes on a machine that may be busy: quote medians, and compare only within one run.
"""

import contextlib
import itertools
import json
import os
import platform
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import psutil

from arm_node.workarounds.local_profile import OF_FAST_DDS_2, OF_FAST_DDS_3

os.environ.setdefault("AMENT_PREFIX_PATH", sys.prefix)

CONTROLLERS = """\
controller_manager:
  ros__parameters:
    update_rate: {rate_hz}
    joint_state_broadcaster:
      type: joint_state_broadcaster/JointStateBroadcaster
    position_controller:
      type: position_controllers/JointGroupPositionController
position_controller:
  ros__parameters:
    joints: [j0, j1, j2, j3]
"""

SETTLED_S = 2.0
"""How long after it is ready a process has taken the memory that it takes."""
CLIENT = Path(__file__).with_name("default_client.py")


@dataclass(frozen=True, slots=True)
class Row:
    """One line of a benchmark's table."""

    what: str
    measured: str
    target: str = ""


def print_table(title: str, rows: list[Row]) -> None:
    """Print a Markdown table."""
    print(f"\n### {title}\n\n| what | measured | target |\n|---|---|---|")
    for row in rows:
        print(f"| {row.what} | {row.measured} | {row.target} |")
    sys.stdout.flush()


def machine() -> str:
    """Return a sentence that names the machine."""
    model = next(
        (
            line.split(":", 1)[1].strip()
            for line in Path("/proc/cpuinfo").read_text().splitlines()
            if line.startswith("model name")
        ),
        platform.machine(),
    )
    return (
        f"{model}, {os.cpu_count()} cores, Linux {platform.release()}, "
        f"Python {platform.python_version()}"
    )


def percentiles(values: list[float] | np.ndarray, *points: float) -> list[float]:
    """Return the percentiles of the values."""
    return [float(np.percentile(values, p)) for p in points]


def client_environment() -> dict[str, str]:
    """A stranger's environment: everything default, but the domain of this run."""
    dropped = ("ROS_AUTOMATIC_DISCOVERY_RANGE", OF_FAST_DDS_2, OF_FAST_DDS_3)
    environment = {k: v for k, v in os.environ.items() if k not in dropped}
    environment["AMENT_PREFIX_PATH"] = sys.prefix
    return environment


_DOMAINS = itertools.cycle(range(1 + os.getpid() % 50, 101))


@contextlib.contextmanager
def fresh_domain() -> Iterator[str]:
    """Give the processes started inside a ROS domain that the run before did not use."""
    os.environ["ROS_DOMAIN_ID"] = str(next(_DOMAINS))
    yield os.environ["ROS_DOMAIN_ID"]


class Suite:
    """A running `arm launch`."""

    def __init__(self, *arguments: str) -> None:
        self.started_s = time.monotonic()
        self.process = subprocess.Popen(
            [sys.executable, "-m", "arm_cli", "launch", *arguments],
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            stdin=subprocess.DEVNULL,
            text=True,
            env=client_environment(),
        )
        self.lines: list[str] = []
        self.ready = threading.Event()
        threading.Thread(target=self._read, daemon=True).start()

    def _read(self) -> None:
        assert self.process.stdout is not None
        for line in self.process.stdout:
            self.lines.append(line.rstrip())
            if line.startswith("ready "):
                self.ready.set()
        self.ready.set()

    def wait_until_ready(self) -> None:
        """Block until the launcher says that everything runs."""
        self.ready.wait(60.0)
        if not any(line.startswith("ready ") for line in self.lines):
            raise SystemExit("the suite did not start:\n" + "\n".join(self.lines))

    def find(self, module: str) -> psutil.Process:
        """Return the process below the launcher whose command line names the module."""
        for process in psutil.Process(self.process.pid).children(recursive=True):
            with contextlib.suppress(psutil.Error):
                if any(module in word for word in process.cmdline()):
                    return process
        raise SystemExit(f"no process {module} below the launcher")

    def memory_mb(self) -> float:
        """Return the proportional memory of the launcher and all that it started, in MB."""
        top = psutil.Process(self.process.pid)
        family = [top, *top.children(recursive=True)]
        return sum(each.memory_full_info().pss for each in family) / 2**20

    def stop(self) -> None:
        """End it as Ctrl-C would."""
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGINT)
        self.process.wait(30.0)


@contextlib.contextmanager
def started(*arguments: str) -> Iterator[Suite]:
    """Run `arm launch` in a domain of its own until it is ready, and end it afterwards."""
    with fresh_domain():
        running = Suite(*arguments)
        try:
            running.wait_until_ready()
            yield running
        finally:
            running.stop()


@contextlib.contextmanager
def suite(*arguments: str, rate_hz: int = 100, parameters: str = CONTROLLERS) -> Iterator[Suite]:
    """Run `arm launch` with this control rate, ready, in a domain of its own."""
    with tempfile.TemporaryDirectory() as folder:
        controllers = Path(folder) / "controllers.yaml"
        controllers.write_text(parameters.format(rate_hz=rate_hz))
        with started(f"controllers:={controllers}", *arguments) as running:
            yield running


class Client:
    """`default_client.py`, or another script, in a process of its own; answers are JSON lines."""

    def __init__(self, *arguments: str, script: Path = CLIENT) -> None:
        self.process = subprocess.Popen(
            [sys.executable, str(script), *arguments],
            stdout=subprocess.PIPE,
            text=True,
            env=client_environment(),
        )

    def answer(self) -> dict:
        """Return the next answer."""
        assert self.process.stdout is not None
        line = self.process.stdout.readline()
        if not line:
            raise SystemExit(f"the client {self.process.args} ended without an answer")
        return json.loads(line)

    def stop(self) -> None:
        """End the client."""
        self.process.terminate()
        self.process.wait(10.0)


def cpu_percent(process: psutil.Process, seconds: float) -> float:
    """Return the share of one core that the process uses over some time."""

    def used() -> float:
        times = process.cpu_times()
        return times.user + times.system

    before, started = used(), time.monotonic()
    time.sleep(seconds)
    return 100.0 * (used() - before) / (time.monotonic() - started)
