"""A shell that runs commands as a page prints them, and compares what they say."""

import os
import pty
import re
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from contextlib import closing
from pathlib import Path

from forked import popen, words_of_arm

TIMEOUT_S = 150.0
"""For a line: a busy machine simulates slower than time passes."""
END_TIMEOUT_S = 20.0
FOREIGN, NOTICE = "[RTPS", "waiting for "
"""In Fast DDS's own errors, and before what a command says that finds things late."""
NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
ANYTHING = "..."
INTERRUPT = "^C"
PREFIX = "/home/me/arm/.venv"
"""What the pages print in place of the virtual environment's folder."""


def pattern(lines: list[str] | tuple[str, ...], exact: bool) -> re.Pattern[str]:
    """Return what matches output whose lines are these.

    A line `...` stands for any lines, `...` within a line for any words. Unless `exact`, one
    number is as good as another, and so is the room that it takes.
    """
    text = ""
    for line in lines:
        if line == ANYTHING:
            text += r"(?:.*\n)*"
            continue
        plain = line.replace(PREFIX, sys.prefix)
        parts = (re.escape(_comparable(part, exact)) for part in plain.split(ANYTHING))
        text += ".*".join(parts) + r"\n"
    return re.compile(text)


def comparable(output: str, exact: bool) -> str:
    """Return output as `pattern` takes it, without empty lines."""
    return "".join(f"{_comparable(line, exact)}\n" for line in output.splitlines() if line.strip())


def as_in_peace(output: str, lines: list[str] | tuple[str, ...]) -> str:
    """Return output without what only a busy machine lets commands say, if no line shows it."""
    tells = any(line.startswith(NOTICE) for line in lines)
    return "".join(
        line
        for line in output.splitlines(keepends=True)
        if FOREIGN not in line and (tells or not line.startswith(NOTICE))
    )


def _comparable(line: str, exact: bool) -> str:
    return line if exact else re.sub(r"[ \t]+", " ", NUMBER.sub("#", line))


def environment_of_reader() -> dict[str, str]:
    """Return the environment in which a reader types commands."""
    search = os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])
    environment = {**os.environ, "PATH": search, "PYTHONUNBUFFERED": "1", "TERM": "dumb"}
    environment.pop("PYTEST_ADDOPTS", None)  # Of this run, not of those that pages show.
    return environment


def ended(line: str, folder: Path) -> tuple[int, str]:
    """Run a command that ends by itself; return its exit code and what it printed.

    One of `arm` that needs no shell is forked from a process that has imported rclpy.
    """
    if words := words_of_arm(line):
        program = popen(words, environment_of_reader(), cwd=folder)
        overdue = threading.Timer(TIMEOUT_S, program.kill)
        overdue.start()
        with closing(program.stdout):
            output = program.stdout.read()
        overdue.cancel()
        return program.wait(), output
    running = Running(line, folder)
    try:
        return running.wait(), running.output
    finally:
        running.close()


class Running:
    """A command that has been started; what it prints is collected."""

    def __init__(self, line: str, folder: Path, terminal: bool = False) -> None:
        near, far = pty.openpty() if terminal else os.pipe()
        self._near = near
        writer = far
        self.process = subprocess.Popen(
            ["/bin/bash", "-c", line],
            stdin=far if terminal else subprocess.DEVNULL,
            stdout=writer,
            stderr=writer,
            env=environment_of_reader(),
            cwd=folder,
            start_new_session=True,
        )
        os.close(far)
        self._output = b""
        self._changed = threading.Condition()
        self._ended = False
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self) -> None:
        """Collect, and close the end that it reads: a later command's might get its number."""
        while not self._ended:
            try:
                more = os.read(self._near, 65536)
            except OSError:  # a terminal whose other side has closed
                more = b""
            with self._changed:
                self._output += more
                self._ended = not more
                self._changed.notify_all()
        os.close(self._near)

    @property
    def output(self) -> str:
        """What has been printed so far."""
        return self._output.decode(errors="replace").replace("\r\n", "\n")

    def type(self, text: str) -> None:
        """Type on the command's terminal."""
        os.write(self._near, text.encode())

    def wait_until_shown(self, lines: list[str], exact: bool = False) -> None:
        """Block until these lines have been printed, with anything behind them."""
        wanted = pattern([*lines, ANYTHING], exact)

        def is_shown(output: str) -> bool:
            return bool(wanted.fullmatch(comparable(as_in_peace(output, lines), exact)))

        self.wait_for(is_shown, lines)

    def wait_for(self, is_right: Callable[[str], bool], what: object) -> None:
        """Block until the output so far is right."""
        deadline = time.monotonic() + TIMEOUT_S
        with self._changed:
            while not is_right(self.output):
                left = deadline - time.monotonic()
                assert not self._ended, f"it ended without {what}:\n{self.output}"
                assert left > 0, f"no {what} in {TIMEOUT_S:g} s:\n{self.output}"
                self._changed.wait(left)

    def interrupt(self) -> None:
        """Do what Ctrl-C in its terminal does."""
        os.killpg(self.process.pid, signal.SIGINT)

    def wait(self) -> int:
        """Wait for the end, and return the exit code."""
        code = self.process.wait(TIMEOUT_S)
        with self._changed:
            assert self._changed.wait_for(lambda: self._ended, TIMEOUT_S), self.output
        return code

    def close(self) -> None:
        """End it, whatever state it is in."""
        if self.process.poll() is None:
            self.interrupt()
            try:
                self.process.wait(END_TIMEOUT_S)
            except subprocess.TimeoutExpired:
                os.killpg(self.process.pid, signal.SIGKILL)
                self.process.wait(END_TIMEOUT_S)
        self._reader.join(END_TIMEOUT_S)


class Background:
    """What a page leaves running; one command at a time."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._running: Running | None = None

    def start(self, line: str, output: tuple[str, ...]) -> None:
        """End what runs, start a command, and wait for what its page shows."""
        self.stop()
        self._running = Running(line, self._folder)
        self._running.wait_until_shown([*output] or [ANYTHING, "ready 1.43 s"])

    def stop(self) -> None:
        """End it."""
        if self._running is not None:
            self._running.close()
        self._running = None
