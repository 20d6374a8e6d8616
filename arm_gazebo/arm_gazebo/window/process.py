"""Run the child process that shows the simulation in a window."""

import logging
import os
import subprocess
from collections.abc import Mapping, Sequence

from arm_gazebo.feed.child_process import NOT_INHERITED, Spawn, WorkerProcess, describe_exit

logger = logging.getLogger(__name__)

MODULE = "arm_gazebo.window"
EXIT_CLOSED = 0
EXIT_FAILED = 2
"""The window cannot open, and the process has logged why."""
EXIT_NEW_MODEL = 3
"""The model has changed. A window shows only one model, so the next process shows the new one."""


class WindowProcess:
    """Runs the window process. Call it from one thread at a time.

    A window that the user closed, or that crashed, does not open again: the user wants it closed,
    and a crash would repeat.
    """

    def __init__(
        self, environ: Mapping[str, str] = os.environ, spawn: Spawn = subprocess.Popen
    ) -> None:
        """Prepare without starting a process.

        Args:
            environ: the simulation's environment, which names the display.
            spawn: starts a process, like subprocess.Popen.
        """
        self._environ = environ
        self._child = WorkerProcess(MODULE, "the window", spawn)

    @property
    def pid(self) -> int | None:
        """Process id of the window; None without a window."""
        return self._child.pid

    def start(self, socket_fd: int) -> None:
        """Start a process that inherits this socket; see `WorkerProcess.start` about the thread."""
        try:
            self._child.start(socket_fd, (), self._environment())
        except OSError as error:
            logger.error("the window cannot be started (%s); the simulation continues", error)

    def start_again_due(self, _backends_tried: Sequence[str]) -> bool:
        """Return whether the window should reopen; log the reason if it will not."""
        code = self._child.take_exit_code()
        if code is None or code == EXIT_NEW_MODEL:
            return code == EXIT_NEW_MODEL
        if code == EXIT_CLOSED:
            logger.info("the window was closed; the simulation continues without it")
        elif code == EXIT_FAILED:
            logger.error("there is no window; the simulation continues without it")
        else:
            logger.error(
                "the window ended %s; the simulation continues without it. A window needs OpenGL "
                "on its display: 'apt install libgl1 libgl1-mesa-dri' where that is missing",
                describe_exit(code),
            )
        return False

    def end(self) -> None:
        """Wait for the process to end after its socket was closed; terminate it if necessary."""
        self._child.end()

    def _environment(self) -> dict[str, str]:
        own = {name: value for name, value in self._environ.items() if name not in NOT_INHERITED}
        # The window creates its own OpenGL context; MuJoCo's off-screen one would interfere.
        own["MUJOCO_GL"] = "off"
        return own
