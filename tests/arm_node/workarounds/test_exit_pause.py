"""A command that used ROS ends at once, with its exit code and all of its output."""

import subprocess
import sys

import pytest

PRELUDE = """
import atexit, os, sys, threading, types
from arm_node.workarounds.exit_pause import end_process
atexit.register(lambda: print("atexit"))
print("output")
"""
USED_ROS = 'sys.modules["rclpy"] = types.ModuleType("rclpy")\n'
A_THREAD = "threading.Thread(target=threading.Event().wait, daemon=True).start()\n"


def end(*lines: str, **options) -> subprocess.CompletedProcess[str]:
    program = "".join([PRELUDE, *lines, "end_process(3)"])
    return subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, timeout=60, **options
    )


@pytest.mark.workaround("exit_pause")
def test_a_process_that_used_ros_ends_without_the_teardown_of_its_libraries():
    ended = end(USED_ROS)
    assert (ended.returncode, ended.stdout, ended.stderr) == (3, "output\n", "")


@pytest.mark.parametrize("lines", [(), (USED_ROS, A_THREAD)], ids=["without ROS", "with a thread"])
def test_other_processes_end_as_usual(lines):
    ended = end(*lines)
    assert (ended.returncode, ended.stdout, ended.stderr) == (3, "output\natexit\n", "")


def test_output_that_cannot_be_written_is_still_an_error():
    with open("/dev/full", "w") as full:
        program = PRELUDE + USED_ROS + "end_process(0)"
        ended = subprocess.run(
            [sys.executable, "-c", program],
            stdout=full,
            stderr=subprocess.PIPE,
            text=True,
            timeout=60,
        )
    assert ended.returncode != 0
    assert "No space left on device" in ended.stderr
