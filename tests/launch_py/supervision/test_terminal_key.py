"""The space bar on the terminal of a launch runs a command; nothing else that is typed does."""

import fcntl
import os
import pty
import signal
import subprocess
import sys
import termios
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

TIMEOUT_S = 60.0
LAUNCH_FILE = """\
from launch_py import ExecuteProcess, LaunchDescription

def generate_launch_description():
    return LaunchDescription([ExecuteProcess(cmd=["sleep", "1000"])])
"""
PROGRAM = """\
import sys

from launch_py.command.command_line import run
from launch_py.supervision.foreground import KeyCommand

command = "print('all', end=' ', flush=True); import time; time.sleep(0.2); print('stands')"
key = KeyCommand("emergency stop", (sys.executable, "-c", command))
sys.exit(run([sys.argv[1]], program="test", key=key))
"""


class OnTerminal:
    """A launch whose terminal the test is."""

    def __init__(self, folder: Path) -> None:
        path = folder / "it.launch.py"
        path.write_text(LAUNCH_FILE)
        self._near, self.far = pty.openpty()
        self.echoed_before = self.echoes()
        self.process = subprocess.Popen(
            [sys.executable, "-c", PROGRAM, str(path)],
            stdin=self.far,
            stdout=self.far,
            stderr=self.far,
            env={**os.environ, "ROS_LOG_DIR": str(folder / "log"), "TERM": "dumb"},
            start_new_session=True,
            preexec_fn=lambda: fcntl.ioctl(0, termios.TIOCSCTTY, 0),
        )
        self.shown = ""
        self._changed = threading.Condition()
        threading.Thread(target=self._read, daemon=True).start()

    def _read(self) -> None:
        while True:
            try:
                text = os.read(self._near, 65536).decode(errors="replace")
            except OSError:
                return
            with self._changed:
                self.shown += text
                self._changed.notify_all()

    def wait_for(self, text: str, count: int = 1) -> None:
        with self._changed:
            assert self._changed.wait_for(lambda: self.shown.count(text) >= count, TIMEOUT_S), (
                self.shown
            )

    def type(self, keys: bytes) -> None:
        os.write(self._near, keys)

    def echoes(self) -> bool:
        """Return whether the terminal waits for whole lines and shows them."""
        modes = termios.tcgetattr(self.far)[3]
        return bool(modes & termios.ICANON and modes & termios.ECHO)

    def close(self) -> None:
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGINT)
        assert self.process.wait(TIMEOUT_S) == 0
        os.close(self.far)


@pytest.fixture
def launch(tmp_path) -> Iterator[OnTerminal]:
    running = OnTerminal(tmp_path)
    yield running
    running.close()


def test_the_space_bar_runs_the_command(launch):
    launch.wait_for("emergency stop: space bar")
    launch.type(b" ")
    launch.wait_for("[launch] all stands")
    launch.type(b" ")
    launch.wait_for("[launch] all stands", count=2)
    assert launch.process.poll() is None


def test_other_keys_do_nothing_and_ctrl_c_ends_the_launch(launch):
    launch.wait_for("ready ")
    launch.type(b"sxq\n\x03")
    launch.wait_for("stopped")
    assert launch.process.wait(TIMEOUT_S) == 0
    assert "[launch] all stands" not in launch.shown


def test_the_terminal_is_afterwards_as_it_was(launch):
    assert launch.echoed_before
    launch.wait_for("ready ")
    assert not launch.echoes()
    launch.process.send_signal(signal.SIGINT)
    assert launch.process.wait(TIMEOUT_S) == 0
    assert launch.echoes()
