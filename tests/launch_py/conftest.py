"""Launches launch files in processes of their own, and expands them in this one.

Nothing here sleeps: every wait is on a condition, with a generous timeout.
"""

import os
import signal
import subprocess
import sys
import textwrap
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TypeVar

import psutil
import pytest
from programs import Program
from run_python import run_python

from arm_node.ros_domain import domain_of_its_own
from launch_py.launch_description import LaunchDescription, expand_description
from launch_py.launch_description_sources import read_launch_file
from launch_py.plan.steps import LaunchPlan
from launch_py.screen import ReadySummary
from launch_py.screen.log_folder import LogFolder
from launch_py.screen.reporter import Reporter
from launch_py.supervision.event_loop import EventLoop
from launch_py.supervision.supervisor import Supervisor
from launch_py.testing import FakeClock, FakeRunner, RecordingScreen

TIMEOUT_S = 100.0
T = TypeVar("T")
IMPORTS = """
import sys
from textwrap import dedent
from launch_py import *
from launch_py.conditions import IfCondition, UnlessCondition
from launch_py.event_handlers import OnProcessExit, OnProcessIO, OnProcessStart, OnShutdown
from launch_py.launch_description_sources import PythonLaunchDescriptionSource
from launch_py.ros import Node, PushRosNamespace
from launch_py.substitutions import *


def python(name, code, **options):
    return ExecuteProcess(cmd=[sys.executable, "-c", dedent(code)], name=name, **options)


def forever(name, **options):
    code = "import signal; print('up', flush=True); signal.pause()"
    return python(name, code, ready=LogLine("^up$"), **options)


"""


def wait_until(condition: Callable[[], T], what: str, timeout_s: float = TIMEOUT_S) -> T:
    """Block until the condition is true and return its result; fail after the timeout."""
    deadline_s = time.monotonic() + timeout_s
    pause = threading.Event()
    while not (result := condition()):
        if time.monotonic() > deadline_s:
            pytest.fail(f"{what} did not happen within {timeout_s} s")
        pause.wait(0.01)
    return result


class Trial:
    """A supervisor whose processes, time and screen belong to the test."""

    def __init__(self, plan, logs: LogFolder, cannot_start=()) -> None:
        self.clock = FakeClock()
        self.loop = EventLoop(self.clock)
        self.runner = FakeRunner(cannot_start)
        self.screen = RecordingScreen()
        self.supervisor = Supervisor(
            plan,
            self.loop,
            self.runner,
            Reporter(self.screen, logs),
            ReadySummary("test", (), (), ()),
            started_s=0.0,
        )
        self.supervisor.begin()

    def __getitem__(self, name):
        return self.runner.children[name]

    @property
    def started(self) -> list[str]:
        return self.runner.started

    def advance(self, seconds: float) -> None:
        self.clock.advance(seconds)
        self.loop.call_due_timers()

    def asked_to_stop(self) -> set[str]:
        return {n for n, child in self.runner.children.items() if child.stop_delays is not None}

    def settle(self) -> None:
        """Wait for the functions that are called beside the loop during the shutdown."""
        self.loop.run(until=lambda: self.supervisor.done)

    def finish(self) -> int:
        assert self.supervisor.done
        self.supervisor.finish_idle()
        self.settle()
        return self.supervisor.finish()


def is_running(pid: int) -> bool:
    """Return whether a process exists and is not a zombie."""
    try:
        return psutil.Process(pid).status() != psutil.STATUS_ZOMBIE
    except psutil.NoSuchProcess:
        return False


@pytest.fixture
def launch_environment(tmp_path):
    environment = {**os.environ, "ROS_LOG_DIR": str(tmp_path / "log")}
    environment.pop("NO_COLOR", None)
    return environment


@pytest.fixture
def write_launch_file(tmp_path):
    """Write a launch file, from its whole text or from the actions of its description."""

    def write(actions: str, name: str = "test.launch.py") -> Path:
        path = tmp_path / name
        body = textwrap.dedent(actions)
        if "def generate_launch_description" not in body:
            body = (
                "def generate_launch_description():\n"
                + textwrap.indent(body, "    ")
                + "\n    return LaunchDescription(actions)\n"
            )
        path.write_text(IMPORTS + body)
        return path

    return write


@pytest.fixture
def launch(write_launch_file, launch_environment):
    """Launch the actions in a process of its own; ends it after the test."""
    launched: list[Program] = []

    def start(actions: str, *arguments: str, **environment: str) -> Program:
        command = [sys.executable, "-m", "launch_py", str(write_launch_file(actions)), *arguments]
        launched.append(Program(command, {**launch_environment, **environment}))
        return launched[-1]

    yield start
    for one in launched:
        one.close(signal.SIGKILL)


@pytest.fixture
def run_launch_py(launch_environment, tmp_path):
    """Run the launcher to its end and return its output."""

    def run(*arguments: str) -> subprocess.CompletedProcess[str]:
        return run_python("-m", "launch_py", *arguments, env=launch_environment, cwd=tmp_path)

    return run


@pytest.fixture
def expand():
    """Expand actions, or a whole description, into a plan."""

    def expand_actions(actions, environ=None, **arguments: str) -> LaunchPlan:
        description = LaunchDescription(actions)
        return expand_description(description, arguments, environ or dict(os.environ))

    return expand_actions


@pytest.fixture
def trial(expand, tmp_path: Path):
    """Supervise the plan of some actions, with fake processes."""
    trials: list[Trial] = []
    logs = LogFolder(tmp_path)

    def begin(*actions, cannot_start=()) -> Trial:
        trials.append(Trial(expand(actions), logs, cannot_start))
        return trials[-1]

    yield begin
    logs.close()
    for one in trials:
        one.loop.close()


@pytest.fixture
def expand_file():
    """Expand a launch file into a plan."""

    def expand_path(path: Path, **arguments: str) -> LaunchPlan:
        return expand_description(read_launch_file(path), arguments, dict(os.environ), path)

    return expand_path


@pytest.fixture
def package_prefix(tmp_path, monkeypatch):
    """Create a prefix; returns a function that adds a package to it."""
    prefix = tmp_path / "prefix"
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(prefix))

    def add(name: str, *executables: str) -> Path:
        marker = prefix / "share" / "ament_index" / "resource_index" / "packages" / name
        marker.parent.mkdir(parents=True, exist_ok=True)
        marker.touch()
        share = prefix / "share" / name
        (share / "launch").mkdir(parents=True)
        for executable in executables:
            path = prefix / "lib" / name / executable
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text("#!/bin/sh\nexit 0\n")
            path.chmod(0o755)
        return share

    return add


@pytest.fixture(scope="session")
def empty_domain() -> Iterator[int]:
    """Return a ROS domain in which nobody listens but these tests.

    Its ports are those of the whole machine: other tests look for participants in other domains.
    """
    with domain_of_its_own() as domain:
        yield domain


@pytest.fixture
def waiting():
    """Return `wait_until`, because test modules cannot import a conftest."""

    class Waiting:
        until = staticmethod(wait_until)
        running = staticmethod(is_running)

    return Waiting
