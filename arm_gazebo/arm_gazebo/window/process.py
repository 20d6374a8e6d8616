"""The child process that shows the simulation in a window, seen from the simulation."""

import logging
import os
import subprocess
from collections.abc import Mapping, Sequence

from arm_gazebo.feed.child_process import NOT_INHERITED, FedProcess, Spawn, describe_exit

logger = logging.getLogger(__name__)

MODULE = "arm_gazebo.window"
EXIT_CLOSED = 0
EXIT_FAILED = 2
"""The window cannot open, and the process has said why."""
EXIT_NEW_MODEL = 3
"""The window shows one model only: the next process shows the new one."""


class WindowProcess:
    """Runs the window's process. One thread at a time.

    A window that was closed, or that broke, stays away: whoever closes it wants that, and what
    broke it would break it again.
    """

    def __init__(
        self, environ: Mapping[str, str] = os.environ, spawn: Spawn = subprocess.Popen
    ) -> None:
        """Prepare; nothing is started.

        Args:
            environ: the simulation's environment, which names the display.
            spawn: makes a process; as subprocess.Popen.
        """
        self._environ = environ
        self._child = FedProcess(MODULE, "the window", spawn)

    @property
    def pid(self) -> int | None:
        """Process id of the window; None where there is none."""
        return self._child.pid

    def start(self, socket_fd: int) -> None:
        """Start a process that inherits this socket; see `FedProcess.start` about the thread."""
        try:
            self._child.start(socket_fd, (), self._environment())
        except OSError as error:
            logger.error("the window cannot be started (%s); the simulation goes on", error)

    def start_again_due(self, _said: Sequence[str]) -> bool:
        """Return whether the window is to open anew; say why if it is gone for good."""
        code = self._child.take_exit_code()
        if code is None or code == EXIT_NEW_MODEL:
            return code == EXIT_NEW_MODEL
        if code == EXIT_CLOSED:
            logger.info("the window was closed; the simulation goes on without it")
        elif code == EXIT_FAILED:
            logger.error("there is no window; the simulation goes on without it")
        else:
            logger.error(
                "the window ended %s; the simulation goes on without it. A window needs OpenGL "
                "on its display: 'apt install libgl1 libgl1-mesa-dri' where that is missing",
                describe_exit(code),
            )
        return False

    def end(self) -> None:
        """Wait until the process has ended, whose socket is closed already; insist if need be."""
        self._child.end()

    def _environment(self) -> dict[str, str]:
        own = {name: value for name, value in self._environ.items() if name not in NOT_INHERITED}
        # The window brings its own OpenGL; MuJoCo's for pictures without one would be in the way.
        own["MUJOCO_GL"] = "off"
        return own
