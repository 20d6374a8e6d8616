"""A child process at the other end of a connection: started, looked at, ended."""

import logging
import os
import signal
import subprocess
import sys
from collections.abc import Callable, Mapping, Sequence

logger = logging.getLogger(__name__)

END_TIMEOUT_S = 3.0
TERMINATE_TIMEOUT_S = 2.0
NOT_INHERITED = ("NOTIFY_SOCKET",)
"""A supervisor waits for the simulation, not for this process of its."""

Spawn = Callable[..., subprocess.Popen[bytes]]


class FedProcess:
    """Runs a module of this package as a process, one at a time. One thread at a time.

    The process inherits a socket and ends when that does. What becomes of one that died is for
    the owner to decide.
    """

    def __init__(self, module: str, name: str, spawn: Spawn = subprocess.Popen) -> None:
        """Prepare; nothing is started.

        Args:
            module: what `python -m` runs.
            name: what to call it in the log.
            spawn: makes a process; as subprocess.Popen.
        """
        self.name = name
        self._module = module
        self._spawn = spawn
        self._process: subprocess.Popen[bytes] | None = None

    @property
    def pid(self) -> int | None:
        """Process id of the child that runs or whose exit code was not taken; None without."""
        return None if self._process is None else self._process.pid

    def start(self, socket_fd: int, arguments: Sequence[str], environ: Mapping[str, str]) -> None:
        """Start a process that inherits this socket.

        Call it from a thread that lives as long as the simulation: when the thread ends, Linux
        ends the process.

        Raises:
            OSError: it cannot be started.
        """
        self._process = self._spawn(
            [
                *(sys.executable, "-P", "-m", self._module),
                *("--socket", str(socket_fd), "--parent", str(os.getpid())),
                *arguments,
            ],
            env=dict(environ),
            pass_fds=(socket_fd,),
            stdin=subprocess.DEVNULL,
            # Out of the reach of Ctrl-C: it ends with the simulation, and not before.
            process_group=0,
        )

    def take_exit_code(self) -> int | None:
        """Return the exit code of a process that has died, once; None if there is none such."""
        code = None if self._process is None else self._process.poll()
        if code is not None:
            self._process = None
        return code

    def end(self) -> None:
        """Wait until the process has ended, whose socket is closed already; insist if need be."""
        process, self._process = self._process, None
        if process is None:
            return
        for insist, timeout_s in (
            (None, END_TIMEOUT_S),
            (process.terminate, TERMINATE_TIMEOUT_S),
            (process.kill, None),
        ):
            if insist is not None:
                insist()
            try:
                process.wait(timeout_s)
                return
            except subprocess.TimeoutExpired:
                logger.warning("%s does not end", self.name)


def describe_exit(code: int) -> str:
    """Return how a process ended, as the end of a sentence."""
    return f"({signal.strsignal(-code)})" if code < 0 else f"with exit code {code}"
