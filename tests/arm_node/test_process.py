"""The end of a process."""

import os
import subprocess
import sys

import pytest
from run_python import run_python

pytestmark = pytest.mark.ros

PROGRAM = """
import signal, sys, threading
from contextlib import contextmanager

from arm_node.process import run_process

@contextmanager
def application(process):
    from rclpy.parameter_service import ParameterService

    def get_a_signal():
        signal.pthread_kill(threading.get_ident(), signal.SIGTERM)

    print(hasattr(ParameterService._set_parameters_callback, "refuses_unknown_types"))
    threading.Timer(1.0, get_a_signal).start()
    yield

sys.exit(run_process(application, ["program"]))
"""


@pytest.fixture(scope="module")
def ended() -> subprocess.CompletedProcess[str]:
    """A process whose nodes guard their parameters, which a signal in another thread has ended."""
    command = [sys.executable, "-c", PROGRAM]
    return subprocess.run(command, stdout=subprocess.PIPE, text=True, timeout=60, check=False)


def test_a_signal_that_another_thread_got_ends_the_process(ended):
    assert ended.returncode == 0


@pytest.mark.workaround("parameter_types")
def test_the_nodes_of_a_process_guard_their_parameters(ended):
    assert ended.stdout == "True\n"


HUNG_UP = """
import os, signal, sys
from contextlib import contextmanager

from arm_node.process import run_process

@contextmanager
def application(process):
    os.kill(os.getpid(), signal.SIGHUP)
    print("ends" if process.stopping else "goes on")
    process.stop()
    yield

signal.signal(signal.SIGHUP, getattr(signal, sys.argv[1]))
sys.exit(run_process(application, ["program"]))
"""


@pytest.mark.parametrize(("inherited", "then"), [("SIG_DFL", "ends"), ("SIG_IGN", "goes on")])
def test_a_terminal_that_goes_ends_the_process_unless_it_runs_under_nohup(inherited, then):
    run = run_python("-c", HUNG_UP, inherited, check=True)
    assert run.stdout.split("\n")[0] == then


ENDLESS = """
import sys
from contextlib import contextmanager

from arm_node.process import run_process

@contextmanager
def application(process):
    from rclpy import create_node
    from rclpy.context import Context
    from rclpy.executors import SingleThreadedExecutor

    def work_without_end():
        context = Context()
        context.init()
        executor = SingleThreadedExecutor(context=context)
        process.stop(7)
        while True:
            executor.spin_once(timeout_sec=0.001)

    node = create_node("worker")
    node.create_timer(0.01, work_without_end)
    process.executor.add_node(node)
    yield

sys.exit(run_process(application, ["program"]))
"""


def test_a_callback_that_does_not_end_is_left_alone():
    run = run_python("-c", ENDLESS)
    assert run.returncode == 7, run.stderr
    assert (
        "a callback in thread 'executor' is still running after 5 s and is abandoned" in run.stderr
    )


LEFT_ALONE = """
import os, sys
from contextlib import contextmanager

from arm_node.process import run_process

@contextmanager
def made(process):
    from rclpy import create_node

    node = create_node("worker")
    node.cycle = node
    node.create_timer(0.01, process.stop)
    process.executor.add_node(node)
    yield

@contextmanager
def refused(process):
    from rclpy import create_node

    node = create_node("worker")
    node.cycle = node
    raise ValueError("no such robot")
    yield

code = run_process(globals()[sys.argv[1]], ["program"], user_errors=(ValueError,))
for thread in os.listdir("/proc/self/task"):
    print(open(f"/proc/self/task/{thread}/comm").read().strip())
sys.exit(code)
"""


@pytest.mark.parametrize(("application", "code"), [("made", 0), ("refused", 1)])
def test_nodes_and_their_participant_end_before_the_process(application, code):
    run = run_python("-c", LEFT_ALONE, application)
    assert run.returncode == code, run.stderr
    threads = run.stdout.split("\n")
    assert any("python" in name for name in threads)
    assert [name for name in threads if name.startswith("dds.ev")] == []


PLAIN = """
import sys
from contextlib import nullcontext

from arm_node.process import run_process

sys.exit(run_process(lambda process: nullcontext(process.stop()), sys.argv))
"""


@pytest.mark.parametrize(
    ("kind", "problem"),
    [("fifo", "it is a FIFO, not a regular file"), ("none", "No such file or directory")],
)
def test_a_parameter_file_that_cannot_be_read_is_a_sentence(tmp_path, kind, problem):
    file = tmp_path / "p.yaml"
    if kind == "fifo":
        os.mkfifo(file)
    run = run_python("-c", PLAIN, "--ros-args", "--params-file", str(file))
    assert (run.returncode, run.stderr) == (2, f"cannot start ROS: cannot read {file}: {problem}\n")


REFUSING = """
import sys

from contextlib import contextmanager

from arm_node.process import run_process

@contextmanager
def application(process):
    from rclpy.node import Node

    class Worker(Node):
        def __init__(self):
            super().__init__("worker")
            raise ValueError("no such robot")

    process.executor.add_node(Worker())
    yield

sys.exit(run_process(application, ["program", *sys.argv[1:]], (ValueError,)))
"""


@pytest.mark.parametrize(
    ("arguments", "name"),
    [((), "worker"), (("--ros-args", "-r", "__node:=other", "-r", "__ns:=/left"), "left.other")],
)
def test_a_node_that_cannot_be_made_says_so_under_its_own_name(arguments, name):
    run = run_python("-c", REFUSING, *arguments)
    assert run.returncode == 1
    assert f"[{name}]: no such robot" in run.stderr
    assert "Traceback" not in run.stderr
