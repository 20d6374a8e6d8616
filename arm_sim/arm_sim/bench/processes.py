"""Processes that tests start: the command of a launch, their output, their children, their end."""

import os
import re
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from pathlib import Path

from arm_sim.errors import BenchError

END_TIMEOUT_S = 60.0
POLL_S = 0.01
NAMED = re.compile(r"sys\.argv\[0\] = '([^']+)'")
"""How launch_py names a node that it starts as a Python function."""


class LoggedProcess:
    """A process with its output so far. Any thread.

    Attributes:
        name: for messages.
        environment: its environment.
        process: the process.
    """

    def __init__(
        self,
        name: str,
        command: Sequence[str],
        environment: Mapping[str, str],
        stdin: int = subprocess.DEVNULL,
    ) -> None:
        """Start it; it does not get the terminal.

        Raises:
            BenchError: there is no such program.
        """
        self.name = name
        self.environment = dict(environment)
        self._lines: list[str] = []
        self._changed = threading.Condition()
        self._is_closed = False
        try:
            self.process = self._start(command, stdin)
        except OSError as error:
            raise BenchError(f"{name} cannot start: {error}") from error
        self._reader = threading.Thread(target=self._read, name=f"log of {name}", daemon=True)
        self._reader.start()

    def _start(self, command: Sequence[str], stdin: int) -> "subprocess.Popen[str]":
        return subprocess.Popen(
            list(command),
            stdin=stdin,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            errors="replace",
            env=self.environment,
        )

    @property
    def log(self) -> str:
        """Its output so far."""
        with self._changed:
            return "\n".join(self._lines)

    def wait_for_line(self, pattern: str, timeout_s: float) -> str:
        """Return the first line of its output in which a regular expression is found.

        Raises:
            BenchError: the process ended first, or there was no such line in time; with its output.
        """
        deadline = time.monotonic() + timeout_s
        with self._changed:
            while True:
                found = next((line for line in self._lines if re.search(pattern, line)), None)
                if found is not None:
                    return found
                left_s = deadline - time.monotonic()
                if self._is_closed or left_s <= 0:
                    why = "has ended" if self._is_closed else f"still runs after {timeout_s:g} s"
                    log = "\n".join(self._lines)
                    raise BenchError(f"{self.name} {why}: no line has '{pattern}'\n{log}")
                self._changed.wait(left_s)

    def descendants(self) -> dict[str, list[int]]:
        """Return the process ids below it by the names of their programs."""
        found: dict[str, list[int]] = {}
        for pid in _descendants(self.process.pid):
            name = _program_name(pid)
            if name:
                found.setdefault(name, []).append(pid)
        return found

    def end(self) -> str:
        """Interrupt it as Ctrl-C does, and wait; return why it did not end properly, or ""."""
        below = list(_descendants(self.process.pid))
        problem = ""
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGINT)
            try:
                self.process.wait(END_TIMEOUT_S)
            except subprocess.TimeoutExpired:
                problem = f"{self.name} does not end within {END_TIMEOUT_S:g} s of SIGINT"
                self.process.kill()
                self.process.wait()
        left = [pid for pid in below if _is_running(pid)]
        for pid in left:
            _kill(pid)
        if left and not problem:
            problem = f"{self.name} has ended, but {len(left)} processes of it were still running"
        self._reader.join(END_TIMEOUT_S)
        if self.process.stdout is not None:
            self.process.stdout.close()
        code = self.process.returncode
        # A program that does not handle SIGINT is ended by it.
        is_failure = code not in (0, -signal.SIGINT)
        ended = f"{self.name} ended with exit code {code}:\n{self.log}" if is_failure else ""
        return problem or ended

    def _read(self) -> None:
        stream = self.process.stdout
        if stream is not None:
            for line in stream:
                with self._changed:
                    self._lines.append(line.rstrip("\n"))
                    self._changed.notify_all()
        with self._changed:
            self._is_closed = True
            self._changed.notify_all()


def _descendants(pid: int) -> Iterator[int]:
    for task in Path(f"/proc/{pid}/task").glob("*/children"):
        try:
            children = task.read_text().split()
        except OSError:  # It has ended meanwhile.
            continue
        for child in map(int, children):
            yield child
            yield from _descendants(child)


def _program_name(pid: int) -> str:
    """Return the name of a program: its file, its Python module, or its name in launch_py."""
    try:
        words = Path(f"/proc/{pid}/cmdline").read_text().split("\0")
    except OSError:
        return ""
    named = NAMED.search(" ".join(words))
    if named:
        return named[1]
    # A Python without a script is a program of the launcher's own.
    names = [Path(word).name for word in words[:2] if word and not word.startswith("-")]
    if not names or not names[0].startswith("python"):
        return names[0] if names else ""
    if "-m" in words[:-1]:
        return words[words.index("-m") + 1].rpartition(".")[2]
    return names[-1].removesuffix(".py") if len(names) > 1 else ""


def _kill(pid: int) -> None:
    """Kill a process, and wait until it is gone."""
    with suppress(ProcessLookupError):
        os.kill(pid, signal.SIGKILL)
    deadline = time.monotonic() + END_TIMEOUT_S
    while _is_running(pid) and time.monotonic() < deadline:
        time.sleep(POLL_S)


def _is_running(pid: int) -> bool:
    try:
        state = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0]
    except OSError:
        return False
    return state != "Z"


ROBOTS: Mapping[str, Sequence[str]] = {"arm": (), "mycobot": ("mycobot",)}
"""What `arm launch` takes for a robot that has a name."""
SIMULATION = ("arm_gazebo", "sim.launch.py")
"""The launch file of any other robot."""


def launch_command(
    *,
    robot: str | None = None,
    world: str | None = None,
    controllers: str | None = None,
    launch: str | Sequence[str] | None = None,
    arguments: Mapping[str, object] | None = None,
    record_to: Path | None = None,
) -> list[str]:
    """Return the command.

    Args:
        robot: "arm", "mycobot", or a URDF or xacro file.
        world: a shipped world's name, or a file.
        controllers: the controllers' parameter file.
        launch: a launch file of your own, or a package and its launch file, instead of a robot.
        arguments: more launch arguments.
        record_to: file to record the run to; the launch of your own file is not recorded.

    Raises:
        BenchError: both a robot and a launch file are given.
    """
    if robot is not None and launch is not None:
        raise BenchError("name a robot or a launch file, not both")
    given: dict[str, object] = {"world": world, "controllers": controllers}
    if launch is None and record_to is not None:
        record_to.parent.mkdir(parents=True, exist_ok=True)
        given["record_run"] = record_to
    if launch is not None:
        words = [launch] if isinstance(launch, str) else list(launch)
    elif robot is None or robot in ROBOTS:
        words = list(ROBOTS[robot or "arm"])
    else:
        words = list(SIMULATION)
        given["model"] = robot
    given.update(arguments or {})
    assigned = [f"{name}:={_text(value)}" for name, value in given.items() if value is not None]
    return [sys.executable, "-P", "-m", "arm_cli", "launch", *words, *assigned]


def _text(value: object) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)
