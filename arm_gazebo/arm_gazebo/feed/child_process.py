"""A child process of the simulation: start it, watch it, end it."""

import ctypes
import logging
import os
import signal
import subprocess
import sys
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING

from arm_gazebo.errors import OrphanError

if TYPE_CHECKING:
    import argparse

PR_SET_PDEATHSIG = 1
NICENESS = 5
"""Software OpenGL uses all processors when it starts; the physics takes precedence."""


def add_parent_arguments(parser: "argparse.ArgumentParser") -> None:
    """Declare the arguments that every child process of the simulation takes."""
    parser.add_argument("--socket", type=int, required=True, help="inherited socket descriptor")
    parser.add_argument("--parent", type=int, required=True, help="process id of the simulation")


def follow_parent(parent: int) -> None:
    """Run at a lower priority than the simulation, and end with it even if a driver hangs.

    Raises:
        OrphanError: the simulation has already ended.
    """
    end_with_parent(parent)
    lower_priority()


def end_with_parent(parent: int) -> None:
    """End this process with the thread that started it, even if that is killed.

    Raises:
        OrphanError: the parent has already ended.
    """
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGTERM, 0, 0, 0)
    if os.getppid() != parent:
        raise OrphanError("the process that started this one has ended")


def lower_priority() -> None:
    """Lower this process's priority, even if the thread that started it had a raised one."""
    inherited = os.getpriority(os.PRIO_PROCESS, 0)
    os.setpriority(os.PRIO_PROCESS, 0, max(0, inherited) + NICENESS)


logger = logging.getLogger(__name__)

END_TIMEOUT_S = 3.0
TERMINATE_TIMEOUT_S = 2.0
NOT_INHERITED = ("NOTIFY_SOCKET",)
"""A supervisor waits for the simulation to report ready, not for its child processes."""

Spawn = Callable[..., subprocess.Popen[bytes]]


class WorkerProcess:
    """Runs a module of this package as a process, at most one at a time.

    The process inherits a socket and ends when that socket closes. The owner decides whether to
    restart a process that died. Call it from one thread at a time.
    """

    def __init__(self, module: str, name: str, spawn: Spawn = subprocess.Popen) -> None:
        """Prepare `python -m MODULE` without starting it; the log calls it by the name."""
        self.name = name
        self._module = module
        self._spawn = spawn
        self._process: subprocess.Popen[bytes] | None = None

    @property
    def pid(self) -> int | None:
        """Process id of the child until `take_exit_code` reports its end; None without a child."""
        return None if self._process is None else self._process.pid

    def start(self, socket_fd: int, arguments: Sequence[str], environ: Mapping[str, str]) -> None:
        """Start a process that inherits this socket.

        Call it from a thread that lives as long as the simulation: when the thread ends, Linux
        ends the process.

        Raises:
            OSError: the process cannot be started.
        """
        self._process = self._spawn(
            [
                *(sys.executable, "-P", "-m", self._module),
                *("--socket", str(socket_fd), "--parent", str(os.getpid())),
                *arguments,
            ],
            env={name: value for name, value in environ.items() if name not in NOT_INHERITED},
            pass_fds=(socket_fd,),
            stdin=subprocess.DEVNULL,
            # Its own group shields it from Ctrl-C, so that it ends with the simulation.
            process_group=0,
        )

    def take_exit_code(self) -> int | None:
        """Return the exit code of a process that has ended, once; None otherwise."""
        code = None if self._process is None else self._process.poll()
        if code is not None:
            self._process = None
        return code

    def end(self) -> None:
        """Wait for the process to end after its socket was closed; terminate it if necessary."""
        process, self._process = self._process, None
        if process is None:
            return
        for escalate, timeout_s in (
            (None, END_TIMEOUT_S),
            (process.terminate, TERMINATE_TIMEOUT_S),
            (process.kill, None),
        ):
            if escalate is not None:
                escalate()
            try:
                process.wait(timeout_s)
                return
            except subprocess.TimeoutExpired:
                logger.warning("%s has not ended after %g s", self.name, timeout_s)


def describe_exit(code: int) -> str:
    """Return how a process ended, worded to finish a sentence."""
    return f"({signal.strsignal(-code)})" if code < 0 else f"with exit code {code}"
