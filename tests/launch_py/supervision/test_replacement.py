"""Replacing running processes; real processes, without ROS."""

import signal
import subprocess
import sys

import pytest

from launch_py.plan.steps import StopDelays
from launch_py.supervision.event_loop import EventLoop
from launch_py.supervision.name_guard import Replacement

CODE = "import signal; {deaf}; print('up', flush=True); signal.pause(); signal.pause()"


@pytest.fixture
def start():
    """Start a process that ignores some signals; kills it after the test."""
    started: list[subprocess.Popen[bytes]] = []

    def begin(*ignored: signal.Signals) -> subprocess.Popen[bytes]:
        deaf = f"[signal.signal(n, signal.SIG_IGN) for n in {[int(n) for n in ignored]}]"
        code = CODE.format(deaf=deaf)
        started.append(
            subprocess.Popen(
                [sys.executable, "-S", "-c", code],
                stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL,
            )
        )
        stdout = started[-1].stdout
        assert stdout is not None
        assert stdout.readline() == b"up\n"
        return started[-1]

    yield begin
    for process in started:
        process.kill()
        process.communicate()


def end(pids, delays: StopDelays) -> list[str]:
    """Run a replacement to its end; return what it refused."""
    loop = EventLoop()
    refusals: list[str] = []
    replacement = Replacement(loop, pids, refusals.append, delays)
    late = loop.call_later(30.0, lambda: pytest.fail("it goes on for ever"))
    loop.run(until=lambda: not replacement.busy)
    late.cancel()
    loop.close()
    return refusals


def test_processes_get_sigint(start):
    processes = [start(), start()]
    assert end([p.pid for p in processes], StopDelays(30.0, 30.0)) == []
    assert [p.wait() for p in processes] == [-signal.SIGINT] * 2


def test_a_process_that_ignores_sigint_gets_sigterm(start):
    process = start(signal.SIGINT)
    assert end([process.pid], StopDelays(0.05, 30.0)) == []
    assert process.wait() == -signal.SIGTERM


def test_a_process_that_ignores_both_is_left_running_and_reported(start):
    process = start(signal.SIGINT, signal.SIGTERM)
    assert end([process.pid], StopDelays(0.05, 0.05)) == [
        f"replace:=true: process {process.pid} does not end after SIGINT and SIGTERM; "
        "end it yourself"
    ]
    assert process.poll() is None


def test_a_process_that_has_ended_is_skipped(start):
    process = start()
    process.kill()
    process.wait()
    assert end([process.pid], StopDelays(30.0, 30.0)) == []
