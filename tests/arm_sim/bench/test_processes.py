"""Processes that tests start, and the command line of their launch."""

import os
import signal
import sys
import time
from pathlib import Path

import pytest

from arm_sim.bench.processes import LoggedProcess, launch_command
from arm_sim.errors import BenchError

PARENT = """
import subprocess, sys
program = "import sys, time; sys.argv[0] = 'the_child'; time.sleep(100)"
child = subprocess.Popen([sys.executable, "-c", program])
print("child", child.pid, flush=True)
child.wait()
"""
STUBBORN = """
import signal, sys
signal.signal(signal.SIGINT, lambda *_: sys.exit(3))
print("up", flush=True)
signal.pause()
"""


def python(program: str) -> LoggedProcess:
    return LoggedProcess("the program", [sys.executable, "-c", program], os.environ)


def is_running(pid: int) -> bool:
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


def test_a_line_of_its_output_is_waited_for():
    process = python("print('one'); print('two 2')")
    assert process.wait_for_line(r"two \d", 30.0) == "two 2"
    assert process.log == "one\ntwo 2"
    process.process.wait(30.0)
    assert process.end() == ""


def test_a_program_that_ends_without_the_line_is_named_with_its_output():
    process = python("print('oh no')")
    with pytest.raises(BenchError, match="the program has ended: no line has 'ready'\noh no"):
        process.wait_for_line("ready", 30.0)
    process.end()


def test_a_program_that_does_not_exist():
    with pytest.raises(BenchError, match="nothing cannot start"):
        LoggedProcess("nothing", ["/no/such/program"], {})


def test_children_have_the_names_that_launch_py_gives_them():
    process = python(PARENT)
    pid = int(process.wait_for_line("child", 30.0).split()[1])
    deadline = time.monotonic() + 30.0
    while "the_child" not in process.descendants() and time.monotonic() < deadline:
        pass  # The child has not replaced its copy of the parent yet.
    assert process.descendants() == {"the_child": [pid]}
    # Ctrl-C reaches the parent alone, which leaves its child.
    assert process.end() == "the program has ended, but 1 processes of it were still running"
    assert not is_running(pid)


def test_an_exit_code_that_is_not_0_is_told():
    process = python(STUBBORN)
    process.wait_for_line("up", 30.0)
    assert process.end() == "the program ended with exit code 3:\nup"


def test_a_program_that_ends_by_the_interrupt_is_clean():
    process = python("import signal; print('up', flush=True); signal.pause()")
    process.wait_for_line("up", 30.0)
    assert process.end() == ""
    assert process.process.returncode == -signal.SIGINT


ARM = [sys.executable, "-P", "-m", "arm_cli", "launch"]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({}, []),
        ({"robot": "arm", "world": "objects"}, ["world:=objects"]),
        ({"robot": "mycobot"}, ["mycobot"]),
        (
            {"robot": "my.urdf", "controllers": "c.yaml"},
            ["arm_gazebo", "sim.launch.py", "controllers:=c.yaml", "model:=my.urdf"],
        ),
        ({"launch": "my.launch.py"}, ["my.launch.py"]),
        ({"launch": ("pkg", "my.launch.py")}, ["pkg", "my.launch.py"]),
        ({"arguments": {"paused": True, "rate": 2}}, ["paused:=true", "rate:=2"]),
    ],
)
def test_the_command(arguments, words):
    assert launch_command(**arguments) == [*ARM, *words]


def test_a_robot_and_a_launch_file_exclude_each_other():
    with pytest.raises(BenchError, match="name a robot or a launch file, not both"):
        launch_command(robot="arm", launch="my.launch.py")


def test_the_run_of_a_robot_is_recorded(tmp_path):
    file = tmp_path / "there" / "test.run"
    assert launch_command(robot="mycobot", record_to=file)[-1] == f"record_run:={file}"
    assert file.parent.is_dir()
    assert launch_command(launch="my.launch.py", record_to=file) == [*ARM, "my.launch.py"]
