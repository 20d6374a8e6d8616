"""The child process that renders, seen from the simulation: start, watch, start again, end."""

import logging
import math
import os
import signal
import subprocess
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

from arm_gazebo.camera.environment import camera_environment
from arm_gazebo.camera.settings import EXIT_BACKEND, CameraSettings
from arm_gazebo.feed.child_process import FedProcess, Spawn, describe_exit

logger = logging.getLogger(__name__)

MODULE = "arm_gazebo.camera_node"
LAST_RESORT = "raycast"
CRASHES = (signal.SIGSEGV, signal.SIGABRT, signal.SIGBUS, signal.SIGFPE, signal.SIGILL)
FIRST_DELAY_S = 1.0
LONGEST_DELAY_S = 30.0
HEALTHY_AFTER_S = 60.0
"""A process that lived so long starts the row of delays anew."""


class CameraProcess:
    """Runs camera processes, one at a time. One thread at a time.

    A process that died is started again after a delay that doubles each time. When it died of a
    crash while it drew with OpenGL, the next one starts at once and leaves that backend out.
    """

    def __init__(
        self,
        settings: CameraSettings,
        ros_arguments: Sequence[str] = (),
        environ: Mapping[str, str] = os.environ,
        clock: Callable[[], float] = time.monotonic,
        spawn: Spawn = subprocess.Popen,
    ) -> None:
        """Prepare; nothing is started.

        Args:
            settings: what each process is told; backends that fail are added to `excluded`.
            ros_arguments: what follows --ros-args, such as remappings.
            environ: the simulation's environment.
            clock: monotonic time in s.
            spawn: makes a process; as subprocess.Popen.
        """
        self._settings = settings
        self._ros_arguments = tuple(ros_arguments)
        self._environ = environ
        self._clock = clock
        self._child = FedProcess(MODULE, "the camera process", spawn)
        self._backend: str | None = None
        self._delay_s = FIRST_DELAY_S
        self._started_s = 0.0
        self._start_again_s = math.inf

    @property
    def pid(self) -> int | None:
        """Process id of the child that runs or has just died; None if there is none."""
        return self._child.pid

    @property
    def settings(self) -> CameraSettings:
        """What the next process is told."""
        return self._settings

    def start(self, socket_fd: int) -> None:
        """Start a process that inherits this socket; see `FedProcess.start` about the thread."""
        arguments = [
            *("--settings", self._settings.to_json()),
            *(("--ros-args", *self._ros_arguments) if self._ros_arguments else ()),
        ]
        self._backend = None
        self._started_s = self._clock()
        try:
            self._child.start(socket_fd, arguments, camera_environment(self._environ))
        except OSError as error:
            self._try_later(f"the camera process cannot be started ({error})")

    def start_again_due(self, backends_tried: Sequence[str]) -> bool:
        """Return whether the process has died and is to be started again now.

        Args:
            backends_tried: backends that the process said it would try, since the last call.
        """
        if backends_tried:
            self._backend = backends_tried[-1]
        code = self._child.take_exit_code()
        if code is not None:
            self._note_death(code)
        return self._child.pid is None and self._clock() >= self._start_again_s

    def end(self) -> None:
        """Wait until the process has ended, whose socket is closed already; insist if need be."""
        self._child.end()

    def _note_death(self, code: int) -> None:
        now = self._clock()
        if now - self._started_s >= HEALTHY_AFTER_S:
            self._delay_s = FIRST_DELAY_S
        how = describe_exit(code)
        if self._backend_failed(code):
            failed = str(self._backend)
            self._settings = replace(self._settings, excluded=(*self._settings.excluded, failed))
            self._start_again_s = now
            logger.warning(
                "the camera process ended %s while it drew with %s; the next one does without %s",
                *(how, failed, failed),
            )
            return
        self._try_later(f"the camera process ended {how}")

    def _try_later(self, what: str) -> None:
        self._start_again_s = self._clock() + self._delay_s
        logger.warning("%s; it starts again in %g s", what, self._delay_s)
        self._delay_s = min(2 * self._delay_s, LONGEST_DELAY_S)

    def _backend_failed(self, code: int) -> bool:
        if self._backend is None or self._backend == LAST_RESORT:
            return False
        return code == EXIT_BACKEND or -code in CRASHES
