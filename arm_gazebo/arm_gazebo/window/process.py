"""The window as the simulation sees it: its child process, and what it is sent."""

import logging
import math
import os
import subprocess
import time
from collections.abc import Callable, Mapping, Sequence

import mujoco

from arm_gazebo.feed.child_process import Spawn, WorkerProcess, describe_exit
from arm_gazebo.feed.state_feed import StateFeed

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
        """Prepare without starting a process; the environment names the display."""
        self._environ = environ
        self._child = WorkerProcess(MODULE, "the window", spawn)

    @property
    def pid(self) -> int | None:
        """Process id of the window; None without a window."""
        return self._child.pid

    def start(self, socket_fd: int) -> None:
        """Start a process that inherits this socket; see `WorkerProcess.start` about the thread."""
        try:
            # The window creates its own OpenGL context; MuJoCo's off-screen one would interfere.
            self._child.start(socket_fd, (), {**self._environ, "MUJOCO_GL": "off"})
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


INTERVAL_S = 1 / 60
"""Wall time between two states; a screen shows no more."""


class WindowFeed(StateFeed):
    """The simulation's side of its window, which is a separate process.

    Call `start`, then `publish_due` at each tick and `supervise` about once a second, and finally
    `close`.
    """

    def __init__(
        self,
        process: WindowProcess | None = None,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        """Prepare without starting the process; `close` is required afterwards.

        By default the child runs on the display that the environment names.
        """
        self._process = process or WindowProcess()
        super().__init__(self._process)
        self._clock = clock
        self._sent_s = -math.inf

    def publish_due(self, time_s: float, data: mujoco.MjData) -> None:
        """Send the state if the last one is old enough. Loop thread only; never waits."""
        now_s = self._clock()
        if self.flowing and now_s - self._sent_s >= INTERVAL_S:
            self._sent_s = now_s
            self.send(time_s, (), data)

    def supervise(self) -> None:
        """Check whether the window still exists; stop sending if it does not."""
        super().supervise()
        if self._process.pid is None:
            self.close()
