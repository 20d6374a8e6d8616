"""Run the camera process from the simulation: its settings, start, watch, restart and end."""

import json
import logging
import math
import os
import signal
import subprocess
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

from arm_description.package_search import share_folders, suite_package
from arm_gazebo.errors import CameraError
from arm_gazebo.feed.child_process import Spawn, WorkerProcess, describe_exit
from arm_gazebo.sensors.camera import CameraSensor
from arm_node.frozen import frozen
from arm_node.workarounds.local_profile import (
    OF_FAST_DDS_2,
    OF_FAST_DDS_3,
    profile_variable,
    use_general_profile,
)

EXIT_BACKEND = 3
"""Exit code of a camera process whose render backend does not work; another one should be tried."""


@frozen
class CameraSettings:
    """Settings that do not change while the simulation runs.

    Attributes:
        cameras: the cameras, in the order of the frames' indices.
        seed: seed of the noise.
        backend: the render backend: auto, egl, osmesa or raycast.
        excluded: backends that crashed an earlier process.
    """

    cameras: tuple[CameraSensor, ...]
    seed: int = 0
    backend: str = "auto"
    excluded: tuple[str, ...] = ()

    def to_json(self) -> str:
        """Return the settings as one line of text."""
        return json.dumps(asdict(self), separators=(",", ":"))

    @classmethod
    def from_json(cls, text: str) -> "CameraSettings":
        """Return the settings from their JSON text.

        Raises:
            CameraError: the text does not hold settings of this version.
        """
        try:
            values = json.loads(text)
            cameras = tuple(_sensor(camera) for camera in values.pop("cameras"))
            return cls(cameras, excluded=tuple(values.pop("excluded")), **values)
        except (ValueError, TypeError, KeyError, AttributeError) as error:
            raise CameraError(f"these are not settings of a camera process: {error}") from error


def _sensor(values: Mapping[str, Any]) -> CameraSensor:
    """Return the sensor with lists converted to tuples, which JSON lacks."""
    fixed: dict[str, Any] = {
        name: tuple(value) if isinstance(value, list) else value for name, value in values.items()
    }
    return CameraSensor(**fixed)


PROFILE_VARIABLES = (OF_FAST_DDS_2, OF_FAST_DDS_3)
PACKAGE = "arm_gazebo"
LARGE_PROFILE = "config/dds_images.xml"
SMALL_PROFILE = "config/dds_images_small.xml"
ROOM_FOR_LARGE_BYTES = 128 << 20
"""Free shared memory required to use the large segment (32 MiB); Docker's default is 64 MiB."""
FITS_SMALL_BYTES = 2 << 20
"""Largest frame of which four fit into the small segment (8 MiB); it is all used in any case."""
LAUNCHER = "launch_py"


def camera_environment(
    environ: Mapping[str, str], frame_bytes: int, shm: str = "/dev/shm"
) -> dict[str, str]:
    """Return the environment for a camera process.

    Args:
        environ: the simulation's own environment.
        frame_bytes: size of a frame of all cameras, which with the free space selects the profile.
        shm: folder of the shared memory.
    """
    # Otherwise importing mujoco loads a window toolkit.
    own = {**environ, "MUJOCO_GL": "off"}
    use_general_profile(own)
    profile = _profile(own, frame_bytes, shm)
    if profile is not None:
        own[profile_variable()] = str(profile)
    return own


def _profile(environ: Mapping[str, str], frame_bytes: int, shm: str) -> Path | None:
    """Return the profile to use; None to keep the user's."""
    if any(environ.get(name) and not _is_launchers(environ[name]) for name in PROFILE_VARIABLES):
        return None
    folder = suite_package(PACKAGE)
    if folder is None:
        return None
    large = frame_bytes > FITS_SMALL_BYTES and _free_bytes(shm) >= ROOM_FOR_LARGE_BYTES
    profile = folder / (LARGE_PROFILE if large else SMALL_PROFILE)
    return profile if profile.is_file() else None


def _is_launchers(profile: str) -> bool:
    """Return whether a profile is the launcher's general one and not one that the user chose."""
    folders = (folder / LAUNCHER for folder in share_folders())
    return any(
        Path(profile).is_relative_to(folder)
        or Path(profile).resolve().is_relative_to((folder / "config").resolve())
        for folder in folders
        if folder.exists()
    )


def _free_bytes(folder: str) -> int:
    try:
        status = os.statvfs(folder)
    except OSError:
        return 0
    return status.f_bavail * status.f_frsize


logger = logging.getLogger(__name__)

MODULE = "arm_gazebo.camera_node"
LAST_RESORT = "raycast"
CRASHES = (signal.SIGSEGV, signal.SIGABRT, signal.SIGBUS, signal.SIGFPE, signal.SIGILL)
FIRST_DELAY_S = 1.0
MAX_DELAY_S = 30.0
HEALTHY_AFTER_S = 60.0
"""A process that ran this long resets the restart delay."""


class CameraProcess:
    """Runs camera processes, at most one at a time. Call it from one thread at a time.

    A process that died is restarted after a delay that doubles each time. If it crashed while it
    rendered with OpenGL, the next one starts at once and does not use that backend.

    Attributes:
        settings: those of the next process.
    """

    def __init__(
        self,
        settings: CameraSettings,
        ros_arguments: Sequence[str] = (),
        environ: Mapping[str, str] = os.environ,
        clock: Callable[[], float] = time.monotonic,
        spawn: Spawn = subprocess.Popen,
    ) -> None:
        """Prepare without starting a process; backends that fail join `settings.excluded`."""
        self.settings = settings
        self._ros_arguments = tuple(ros_arguments)
        self._environ = environ
        self._clock = clock
        self._child = WorkerProcess(MODULE, "the camera process", spawn)
        self._backend: str | None = None
        self._delay_s = FIRST_DELAY_S
        self._started_s = 0.0
        self._start_again_s = math.inf

    @property
    def pid(self) -> int | None:
        """Process id of the child that runs or has just died; None if there is none."""
        return self._child.pid

    def start(self, socket_fd: int) -> None:
        """Start a process that inherits this socket; see `WorkerProcess.start` about the thread."""
        arguments = [
            *("--settings", self.settings.to_json()),
            *(("--ros-args", *self._ros_arguments) if self._ros_arguments else ()),
        ]
        self._backend = None
        self._started_s = self._clock()
        frame_bytes = sum(camera.frame_bytes for camera in self.settings.cameras)
        environment = camera_environment(self._environ, frame_bytes)
        try:
            self._child.start(socket_fd, arguments, environment)
        except OSError as error:
            self._restart_later(f"the camera process cannot be started ({error})")

    def start_again_due(self, backends_tried: Sequence[str]) -> bool:
        """Return whether the process has died and should be restarted now.

        Args:
            backends_tried: backends that the process has announced since the last call.
        """
        if backends_tried:
            self._backend = backends_tried[-1]
        code = self._child.take_exit_code()
        if code is not None:
            self._handle_exit(code)
        return self._child.pid is None and self._clock() >= self._start_again_s

    def end(self) -> None:
        """Wait for the process to end after its socket was closed; terminate it if necessary."""
        self._child.end()

    def _handle_exit(self, code: int) -> None:
        now = self._clock()
        if now - self._started_s >= HEALTHY_AFTER_S:
            self._delay_s = FIRST_DELAY_S
        how = describe_exit(code)
        if self._backend_failed(code):
            failed = str(self._backend)
            self.settings = replace(self.settings, excluded=(*self.settings.excluded, failed))
            self._start_again_s = now
            logger.warning(
                "the camera process ended %s while it used %s; the next one runs without %s",
                *(how, failed, failed),
            )
            return
        self._restart_later(f"the camera process ended {how}")

    def _restart_later(self, what: str) -> None:
        self._start_again_s = self._clock() + self._delay_s
        logger.warning("%s; it starts again in %g s", what, self._delay_s)
        self._delay_s = min(2 * self._delay_s, MAX_DELAY_S)

    def _backend_failed(self, code: int) -> bool:
        if self._backend is None or self._backend == LAST_RESORT:
            return False
        return code == EXIT_BACKEND or -code in CRASHES
