"""The end of a process."""

import subprocess
import sys

import pytest

pytestmark = pytest.mark.ros

PROGRAM = """
import signal, sys, threading
from contextlib import contextmanager

from arm_node.process import run_process

@contextmanager
def application(process):
    def get_a_signal():
        signal.pthread_kill(threading.get_ident(), signal.SIGTERM)
    threading.Timer(1.0, get_a_signal).start()
    yield

sys.exit(run_process(application, ["program"]))
"""


def test_a_signal_that_another_thread_got_ends_the_process():
    run = subprocess.run([sys.executable, "-c", PROGRAM], timeout=60, check=False)
    assert run.returncode == 0
