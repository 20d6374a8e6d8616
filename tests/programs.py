"""A program that a test runs beside itself: the process of the test bench, and ways to wait for it.

Nothing here sleeps: every wait is on a condition, with a generous timeout.
"""

import os
import re
import signal
import subprocess
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from pathlib import Path

import psutil
import pytest
from forked import popen

from arm_node.workarounds.ports import lost_ports
from arm_sim.bench.processes import LoggedProcess

TIMEOUT_S = 100.0
END_TIMEOUT_S = 60.0
ESCAPES = re.compile("\x1b\\[[0-9;]*m")


class Program(LoggedProcess):
    """A running program and its output.

    Args:
        command: the program and its arguments.
        environment: its environment; by default that of the tests.
        stdin: what it reads; by default it finds its end. `tell` needs a pipe.
    """

    def __init__(
        self,
        command: Sequence[str | Path],
        environment: Mapping[str, str] | None = None,
        stdin: int = subprocess.DEVNULL,
    ) -> None:
        words = [os.fspath(word) for word in command]
        super().__init__(" ".join(words[:4]), words, environment or os.environ, stdin)

    @property
    def lines(self) -> list[str]:
        """The lines of its output so far."""
        with self._changed:
            return list(self._lines)

    @property
    def output(self) -> str:
        """Its output so far."""
        return self.log

    @property
    def own_words(self) -> list[str]:
        """The lines so far that are not Fast DDS's own, which complains on a loaded machine."""
        return [line for line in self.lines if "[RTPS" not in ESCAPES.sub("", line)]

    def wait_for_line(self, text: str, timeout_s: float = TIMEOUT_S) -> str:
        """Block until a line that contains `text` has been printed; return it."""
        return super().wait_for_line(re.escape(text), timeout_s)

    def wait_for(self, pattern: str, count: int = 1) -> str:
        """Block until `count` lines match; return the last of them."""

        def found() -> list[str]:
            return [line for line in self._lines if re.search(pattern, line)]

        self._wait_until(lambda: len(found()) >= count, f"{count} lines that match {pattern!r}")
        return found()[count - 1]

    def wait_until_ready(self) -> None:
        """Block until the launcher reports that everything is ready."""
        super().wait_for_line("^ready ", TIMEOUT_S)

    def tell(self, line: str) -> None:
        """Write a line to its standard input and wait until it has obeyed."""
        assert self.process.stdin is not None
        done = f"{line} done"
        # It may have been told so before.
        before = self.lines.count(done)
        self.process.stdin.write(f"{line}\n")
        self.process.stdin.flush()
        self._wait_until(lambda: self._lines.count(done) > before, repr(done))

    def _wait_until(self, is_so: Callable[[], bool], what: str) -> None:
        deadline = time.monotonic() + TIMEOUT_S
        with self._changed:
            while not is_so():
                left_s = deadline - time.monotonic()
                if self._is_closed or left_s <= 0:
                    pytest.fail(f"{self.name}: no {what}:\n" + "\n".join(self._lines))
                self._changed.wait(left_s)

    def processes(self, *words: str) -> list[psutil.Process]:
        """All processes below it, or those whose command line contains one of these words."""
        below = psutil.Process(self.process.pid).children(recursive=True)
        return [one for one in below if not words or any(word in _command(one) for word in words)]

    def wait(self, timeout_s: float = TIMEOUT_S) -> int:
        """Wait for its end; return the exit code."""
        try:
            code = self.process.wait(timeout_s)
        except subprocess.TimeoutExpired:
            lost = lost_ports(f"/proc/{self.process.pid}")
            deaf = f", and hears nothing, without {lost}" if lost else ""
            pytest.fail(f"{self.name} still runs after {timeout_s:g} s{deaf}:\n{self.output}")
        self._reader.join(timeout_s)
        print(self.output)  # Shown if the test fails.
        return code

    def succeed(self) -> str:
        """Wait for it to exit successfully; return its output."""
        return self._output_at_end(0)

    def fail(self, code: int = 1) -> str:
        """Wait for its end, which must be a failure without a traceback; return its output."""
        return self._output_at_end(code)

    def _output_at_end(self, code: int) -> str:
        assert self.wait() == code, self.output
        assert "Traceback" not in self.output
        return self.output

    def stop(self, number: int = signal.SIGINT, timeout_s: float = 60.0) -> int:
        """Send a signal, wait for the end, and return the exit code."""
        if self.process.poll() is None:
            self.process.send_signal(number)
        return self.wait(timeout_s)

    def close(self, number: int = signal.SIGINT) -> None:
        """Make sure that it is gone, whatever the test did."""
        if self.process.poll() is None:
            self.process.send_signal(number)
            try:
                self.process.wait(END_TIMEOUT_S)
            except subprocess.TimeoutExpired:
                self.process.kill()
                self.process.wait(END_TIMEOUT_S)
        self._reader.join(END_TIMEOUT_S)
        for pipe in (self.process.stdin, self.process.stdout):
            if pipe is not None:
                pipe.close()


def _command(process: psutil.Process) -> str:
    """Return a process's command line, "" if it has ended meanwhile."""
    with suppress(psutil.NoSuchProcess):
        return " ".join(process.cmdline())
    return ""


class RosProgram(Program):
    """A program of Python that begins with rclpy imported: see `forked`."""

    def _start(self, command: Sequence[str], stdin: int) -> "subprocess.Popen[str]":
        return popen(command, self.environment, stdin=stdin)
