"""One simulation for the tests of a file, and `arm` command lines run by a shell."""

import os
import signal
import subprocess
import sys
import threading
import time
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from forked import popen, words_of_arm

from arm_cli.bag_format.reader import BagReader
from arm_cli.errors import BagError
from launch_py.fast_dds.removal import SharedMemoryLedger

TIMEOUT_S = 120.0
END_TIMEOUT_S = 60.0
FOREIGN = "RTPS_TRANSPORT_SHM"
"""The common part of Fast DDS's own errors about shared memory."""


class CommandLine:
    """A running command line in a shell, such as a tutorial prints."""

    def __init__(self, line: str, folder: Path) -> None:
        search = os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])
        self._changed = threading.Condition()
        self._texts = {"out": "", "err": ""}
        environment = {**os.environ, "PATH": search}
        self.process = popen(_words(line), environment, stderr=subprocess.PIPE, cwd=folder)
        self._readers = [
            threading.Thread(target=self._read, args=(name, stream), daemon=True)
            for name, stream in (("out", self.process.stdout), ("err", self.process.stderr))
        ]
        for reader in self._readers:
            reader.start()

    @property
    def out(self) -> str:
        """The output on stdout so far."""
        return self._texts["out"]

    @property
    def err(self) -> str:
        """The output on stderr so far."""
        return self._texts["err"]

    def _read(self, name: str, stream) -> None:
        for line in stream:
            # Of shared memory of other programs, which may have been killed; no word of the line's.
            if FOREIGN in line:
                continue
            with self._changed:
                self._texts[name] += line
                self._changed.notify_all()

    def wait_for(self, text: str) -> None:
        """Block until a text has been printed."""
        deadline = time.monotonic() + TIMEOUT_S
        with self._changed:
            while text not in self.out + self.err:
                left = deadline - time.monotonic()
                if left <= 0 or not any(reader.is_alive() for reader in self._readers):
                    pytest.fail(f"{text!r} was not printed, but:\n{self.out}\n{self.err}")
                self._changed.wait(min(left, 0.2))

    def wait_until(self, condition: Callable[[], bool], what: str) -> None:
        """Block until the running command makes a condition true."""
        deadline = time.monotonic() + TIMEOUT_S
        with self._changed:
            while not condition():
                if time.monotonic() > deadline or self.process.poll() is not None:
                    pytest.fail(f"it did not come to this: {what}\n{self.out}\n{self.err}")
                self._changed.wait(0.1)

    def wait(self) -> int:
        """Block until the end; return the exit code."""
        try:
            code = self.process.wait(TIMEOUT_S)
        except subprocess.TimeoutExpired:
            pytest.fail(f"it did not end within {TIMEOUT_S} s:\n{self.out}\n{self.err}")
        for reader in self._readers:
            reader.join(TIMEOUT_S)
        return code

    def interrupt(self) -> int:
        """Press Ctrl-C; return the exit code."""
        self.process.send_signal(signal.SIGINT)
        return self.wait()

    def kill(self) -> None:
        """Kill the command, so that it cannot clean up; remove the middleware's files for it."""
        ledger = SharedMemoryLedger(lambda pid: pid == self.process.pid)
        ledger.observe()
        self.process.kill()
        self.wait()
        ledger.sweep()

    def close(self) -> None:
        """End the command, whatever the test did.

        Killed, it might hold a lock in the shared memory of others, who would then hang.
        """
        if self.process.poll() is None:
            self.process.terminate()
            try:
                self.process.wait(END_TIMEOUT_S)
            except subprocess.TimeoutExpired:
                self.process.kill()
        self.wait()
        for stream in (self.process.stdout, self.process.stderr):
            if stream is not None:
                stream.close()


def _words(line: str) -> list[str]:
    """Return what runs a command line: a shell only where the line needs one."""
    if words := words_of_arm(line):
        return words
    # `exec` makes the shell's process that of a single command, for signals.
    single = not any(word in line for word in ("|", "&&", ";"))
    return ["/bin/bash", "-c", f"exec {line}" if single else line]


@pytest.fixture
def start(tmp_path: Path) -> Iterator[Callable[[str], CommandLine]]:
    """Start a command line, which ends with the test at the latest."""
    yield from _starter(tmp_path)


@pytest.fixture(scope="module")
def start_for_file(
    tmp_path_factory: pytest.TempPathFactory,
) -> Iterator[Callable[[str], CommandLine]]:
    """Start a command line, which ends with the last test of the file at the latest."""
    yield from _starter(tmp_path_factory.mktemp("commands"))


def _starter(folder: Path) -> Iterator[Callable[[str], CommandLine]]:
    started: list[CommandLine] = []

    def run(line: str) -> CommandLine:
        started.append(CommandLine(line, folder))
        return started[-1]

    yield run
    for command in started:
        command.close()


@pytest.fixture
def run(start: Callable[[str], CommandLine]) -> Callable[..., str]:
    """Run a command line to its end, check its exit code and return its output."""

    def finish(line: str, code: int = 0) -> str:
        command = start(line)
        ended = command.wait()
        assert ended == code, f"{line}\n{command.out}\n{command.err}"
        return command.out if code == 0 else command.out + command.err

    return finish


@pytest.fixture
def run_until(start: Callable[[str], CommandLine]) -> Callable[..., str]:
    """Run a command line again and again until it prints what it should; return that.

    What starts up and what is discovered may come late on a busy machine.
    """

    def repeat(line: str, is_right: Callable[[str], object], code: int = 0) -> str:
        deadline = time.monotonic() + TIMEOUT_S
        while True:
            command = start(line)
            ended = command.wait()
            text = command.out if code == 0 else command.out + command.err
            if ended == code and is_right(text):
                return text
            if time.monotonic() > deadline:
                pytest.fail(f"{line}: exit code {ended}\n{command.out}\n{command.err}")

    return repeat


@pytest.fixture(scope="session")
def counts() -> Callable[[Path], Counter[str]]:
    """Return a function that counts the messages in a bag, even while it is being recorded."""

    def counts_of(bag: Path) -> Counter[str]:
        try:
            with BagReader(bag) as reader:
                return Counter({topic.name: count for topic, count in reader.metadata.topics})
        except BagError:
            return Counter()

    return counts_of


@pytest.fixture(scope="module")
def simulation(launch_for_file):
    """The main job without its camera, ready."""
    return _ready(launch_for_file("camera:=none"))


@pytest.fixture(scope="module")
def simulation_with_camera(launch_for_file):
    """The main job, ready."""
    return _ready(launch_for_file())


def _ready(launched):
    launched.wait_until_ready()
    return launched
