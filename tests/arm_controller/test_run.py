"""How a process with a node ends, each in a process of its own."""

import os
import subprocess
from pathlib import Path

import pytest
from run_python import run_python

pytestmark = pytest.mark.ros

PROGRAM = """
import os, signal, sys
import rclpy
from rclpy.node import Node
from arm_controller.pose import PoseError
from arm_controller.ros_node import run


def fail(error):
    raise error


{code}
sys.exit(run(make, work))
"""


def ended(code: str, log_folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    return run_python(
        "-c",
        PROGRAM.format(code=code),
        *arguments,
        env={**os.environ, "ROS_LOG_DIR": str(log_folder)},
    )


NODE = 'make = lambda: Node("made")\n'
# As where rclpy converts a message while the signal comes.
LOST = """
def work(node):
    try:
        os.kill(os.getpid(), signal.{name})
    except KeyboardInterrupt:
        raise RuntimeError("Unable to convert call argument") from None
"""
STOPPED = "def make():\n    rclpy.shutdown()\n    return Node('late')\nwork = None"


@pytest.mark.parametrize(
    ("code", "exit_code"),
    [
        (NODE + "work = lambda node: None", 0),
        (NODE + "work = lambda node: 3", 3),
        (NODE + "work = lambda node: os.kill(os.getpid(), signal.SIGTERM)", 0),
        (NODE + "work = lambda node: os.kill(os.getpid(), signal.SIGHUP)", 0),
        (NODE + "work = lambda node: sys.exit(4)", 4),
        (NODE + LOST.format(name="SIGINT"), 0),
        (NODE + LOST.format(name="SIGTERM"), 0),
        (STOPPED, 0),
    ],
)
def test_the_end_of_the_work_and_a_signal_are_no_failures(tmp_path, code, exit_code):
    done = ended(code, tmp_path)
    assert (done.returncode, done.stderr) == (exit_code, "")


@pytest.mark.parametrize(
    ("code", "sentence"),
    [
        (NODE + "work = lambda node: fail(PoseError('it is too far'))", "it is too far"),
        ("make = lambda: fail(PoseError('it is too far'))\nwork = None", "it is too far"),
        ("make = lambda: Node('a b')\nwork = None", "Invalid node name"),
    ],
)
def test_a_mistake_of_the_user_is_a_sentence(tmp_path, code, sentence):
    done = ended(code, tmp_path)
    assert done.returncode == 1
    assert sentence in done.stderr
    assert "Traceback" not in done.stderr


def test_ros_arguments_that_do_not_exist_are_named(tmp_path):
    done = ended(NODE + "work = None", tmp_path, "--ros-args", "--nope")
    assert done.returncode == 1
    assert "--nope" in done.stderr
    assert "Traceback" not in done.stderr


def test_a_mistake_in_the_program_has_its_traceback(tmp_path):
    done = ended(NODE + "work = lambda node: fail(RuntimeError('a bug'))", tmp_path)
    assert done.returncode == 1
    assert "Traceback" in done.stderr
