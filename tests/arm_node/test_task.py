"""A process that does one thing: how its task ends it."""

import signal
import subprocess
import sys
from collections.abc import Callable, Iterator

import pytest

pytestmark = pytest.mark.ros

PROGRAM = """\
import sys
from arm_node.task import run_task

class Mistake(Exception):
    pass

def task(node, process):
    {body}

sys.exit(run_task("worker", task, ["worker", *sys.argv[1:]], user_errors=(Mistake,)))
"""
TIMEOUT_S = 60.0


@pytest.fixture
def start() -> Iterator[Callable[..., subprocess.Popen[str]]]:
    """Return a function that runs a task, given as the body of a function, with arguments."""
    started: list[subprocess.Popen[str]] = []

    def run(body: str, *arguments: str) -> subprocess.Popen[str]:
        process = subprocess.Popen(
            [sys.executable, "-c", PROGRAM.format(body=body), *arguments],
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )
        started.append(process)
        return process

    yield run
    for process in started:
        process.kill()
        process.communicate()


@pytest.mark.parametrize(
    ("body", "code", "said", "traceback"),
    [
        ("return 3", 3, "", False),
        ("raise Mistake('no such thing')", 1, "[worker]: no such thing", False),
        ("raise ValueError('oops')", 1, "[worker]: the task failed", True),
    ],
)
def test_it_ends_with_the_process(start, body, code, said, traceback):
    process = start(body)
    output, _ = process.communicate(timeout=TIMEOUT_S)
    assert process.returncode == code
    assert said in output
    assert ("Traceback" in output) is traceback


def test_a_task_notices_a_signal(start):
    process = start("print('at work', flush=True); return 5 if process.wait(60.0) else 4")
    assert process.stdout is not None
    assert "at work\n" in process.stdout
    process.send_signal(signal.SIGTERM)
    process.communicate(timeout=TIMEOUT_S)
    assert process.returncode == 5


@pytest.mark.parametrize(
    ("arguments", "code", "said"),
    [
        ("-p use_sim_time:=5", 1, "cannot create the node: Trying to set parameter 'use_sim_time'"),
        ("-r __node:=a-b", 2, "cannot start ROS: failed to initialize rcl: Couldn't parse remap"),
        ("--foo", 2, "cannot start ROS: unknown arguments after --ros-args: ['--foo']"),
    ],
)
def test_arguments_that_rclpy_refuses_are_a_sentence(start, arguments, code, said):
    process = start("return 0", "--ros-args", *arguments.split())
    output, _ = process.communicate(timeout=TIMEOUT_S)
    assert process.returncode == code
    assert said in output
    assert "Traceback" not in output
