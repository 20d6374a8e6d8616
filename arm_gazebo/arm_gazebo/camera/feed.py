"""Hands states of the simulation to the camera process, whenever a camera takes a picture."""

import math
import time
from collections.abc import Callable, Sequence

import mujoco

from arm_gazebo.camera.process import CameraProcess
from arm_gazebo.camera.settings import CameraSettings
from arm_gazebo.feed.schedule import FrameDue, FrameSchedule
from arm_gazebo.feed.state_feed import PreparedModel, StateFeed
from arm_gazebo.rendering.backend_selection import backend_order
from arm_gazebo.rendering.renderer import camera_id
from arm_gazebo.sensors.camera import CameraSensor

LEAST_INTERVAL_S = 0.002
"""Wall time between two states for one camera. A simulation that runs as fast as possible would
keep the camera process busy with more than anybody can look at."""


class CameraFeed:
    """The simulation's side of its cameras. Nothing that happens to them reaches the physics.

    Pictures are drawn and published by a child process, which gets the states in which they are
    due; where it cannot follow, frames are lost, and it counts them.

    `start`, `set_model`, then `publish_due` at each tick and `supervise` now and then; `close`.
    """

    def __init__(
        self,
        cameras: Sequence[CameraSensor],
        render_backend: str = "auto",
        seed: int = 0,
        ros_arguments: Sequence[str] = (),
        make_process: Callable[[CameraSettings, Sequence[str]], CameraProcess] = CameraProcess,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        """Prepare; nothing is started, but `close` is needed from here on.

        Args:
            cameras: the cameras of the model; at least one.
            render_backend: auto, egl, osmesa or raycast.
            seed: of the cameras' noise.
            ros_arguments: what the camera node gets after --ros-args, such as `-r __ns:=/lab`.
            make_process: makes what runs the child.
            clock: wall time in s.

        Raises:
            CameraError: an unknown backend; the message names the known ones.
        """
        backend_order(render_backend)
        self._cameras = tuple(cameras)
        settings = CameraSettings(self._cameras, seed, render_backend)
        self._feed = StateFeed(make_process(settings, ros_arguments))
        self._schedule = FrameSchedule([camera.rate_hz for camera in self._cameras])
        self._clock = clock
        self._sent_s = [-math.inf] * len(self._cameras)

    def start(self, model: mujoco.MjModel | None = None) -> None:
        """Start the camera process; see `StateFeed.start`.

        Raises:
            CameraError: as `set_model`, where a model is given.
        """
        self._feed.start()
        if model is not None:
            self.set_model(model)

    def set_model(self, model: mujoco.MjModel) -> None:
        """Draw this model from the next state on; see `StateFeed.set_model`.

        Raises:
            CameraError: the model lacks one of the cameras, or its state is too large to send.
        """
        self.prepare(model).show()

    def prepare(self, model: mujoco.MjModel) -> PreparedModel:
        """Return a model to be drawn later; see `StateFeed.prepare`.

        Raises:
            CameraError: the model lacks one of the cameras, or its state is too large to send.
        """
        for camera in self._cameras:
            camera_id(model, camera)
        return self._feed.prepare(model)

    def publish_due(self, time_s: float, data: mujoco.MjData) -> None:
        """Send the state if a camera takes a picture at this tick; loop thread only.

        Never waits.

        Args:
            time_s: simulation time of the state.
            data: the state.
        """
        if self._schedule.nothing_due(time_s):
            return
        now_s = self._clock()
        frames = tuple(
            frame for frame in self._schedule.take_due(time_s) if self._may_send(frame, now_s)
        )
        if frames:
            self._feed.send(time_s, frames, data)

    def supervise(self) -> None:
        """Start the camera process again if it has died; see `StateFeed.supervise`."""
        self._feed.supervise()

    def close(self) -> None:
        """End the camera process and wait for it, some seconds at most; idempotent. Any thread."""
        self._feed.close()

    def _may_send(self, frame: FrameDue, now_s: float) -> bool:
        if not self._feed.flowing or now_s - self._sent_s[frame.camera] < LEAST_INTERVAL_S:
            return False
        self._sent_s[frame.camera] = now_s
        return True
