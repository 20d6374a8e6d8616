"""Sends states of the simulation to the camera process when a camera frame is due."""

import math
import time
from collections.abc import Callable, Sequence

import mujoco

from arm_gazebo.camera.process import CameraProcess, CameraSettings
from arm_gazebo.feed.schedule import FrameDue, FrameSchedule, StreamCount
from arm_gazebo.feed.socket_pair import CameraProgress
from arm_gazebo.feed.state_feed import PreparedModel, StateFeed
from arm_gazebo.rendering.backend_selection import backend_order
from arm_gazebo.rendering.renderer import camera_id
from arm_gazebo.sensors.camera import CameraSensor

LEAST_INTERVAL_S = 0.002
"""Smallest wall time between two states for one camera. A simulation that runs as fast as possible
would otherwise overload the camera process with images that nobody can look at."""


class CameraFeed(StateFeed):
    """The simulation's side of its cameras. A fault of the cameras never affects the physics.

    A child process renders and publishes the images. It receives a state whenever a frame is due.
    If it cannot keep up, frames are lost, and it counts them.

    Call `start` and `set_model`, then `publish_due` at each tick and `supervise` about once a
    second, and finally `close`.

    Attributes:
        schedule: when the next pictures are due; it is part of the state of a run.
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
        """Prepare without starting the process; `close` is required afterwards.

        Args:
            cameras: the cameras of the model; at least one.
            render_backend: auto, egl, osmesa or raycast.
            seed: seed of the cameras' noise.
            ros_arguments: the camera node's arguments after --ros-args, such as `-r __ns:=/lab`.
            make_process: creates the object that runs the child process.
            clock: wall time in s.

        Raises:
            CameraError: the backend is unknown; the message names the known ones.
        """
        backend_order(render_backend)
        self._cameras = tuple(cameras)
        settings = CameraSettings(self._cameras, seed, render_backend)
        super().__init__(make_process(settings, ros_arguments))
        self.schedule = FrameSchedule([camera.rate_hz for camera in self._cameras])
        self._clock = clock
        self._sent_s = [-math.inf] * len(self._cameras)
        self._sent = [-1] * len(self._cameras)
        self._sent_version = 0
        self._missed = [0] * len(self._cameras)

    def prepare(self, model: mujoco.MjModel) -> PreparedModel:
        """Return a model to draw later; see `StateFeed.prepare`.

        Raises:
            CameraError: the model lacks one of the cameras, or its state is too large to send.
        """
        for camera in self._cameras:
            camera_id(model, camera)
        return super().prepare(model)

    def publish_due(self, time_s: float, data: mujoco.MjData) -> None:
        """Send the state if a camera frame is due at this tick. Loop thread only; never waits."""
        if self.schedule.nothing_due(time_s):
            return
        now_s = self._clock()
        due = self.schedule.take_due(time_s)
        frames = tuple(frame for frame in due if self._may_send(frame, now_s))
        if not (frames and self.send(time_s, frames, data)):
            frames = ()
        if frames and self._sent_version != self.version:
            self._sent_version = self.version
            self._sent = [-1] * len(self._cameras)
        for frame in frames:
            self._sent[frame.camera] = frame.serial
        if len(frames) < len(due):
            for frame in due:
                self._missed[frame.camera] += frame not in frames

    def counts(self) -> tuple[StreamCount, ...]:
        """Return the cameras' figures; those of the camera process are up to half a second old."""
        progress = self.progress or (CameraProgress(),) * len(self._cameras)
        return tuple(
            StreamCount(camera.name, "camera", camera.rate_hz, due, done.rendered, done.dropped)
            for camera, due, done in zip(
                self._cameras, self.schedule.serials, progress, strict=True
            )
        )

    def missed(self) -> dict[str, int]:
        """Return how many due frames of each camera were never sent; the loop is paused."""
        names = (camera.name for camera in self._cameras)
        return dict(zip(names, self._missed, strict=True))

    def unpublished(self, timeout_s: float) -> tuple[str, ...]:
        """Return the cameras whose last frame has not been published yet, while the loop is paused.

        Args:
            timeout_s: how long to wait for the camera process to publish something.
        """
        found = self._late()
        if found:
            self.hear(timeout_s)
            found = self._late()
        return found

    def forget_pace(self) -> None:
        """Allow the next frame at once, because all earlier ones are published. Loop thread."""
        self._sent_s = [-math.inf] * len(self._cameras)

    def _late(self) -> tuple[str, ...]:
        if self._sent_version != self.version:
            return ()  # A frame of the model before, which the process may never have received.
        progress = self.progress or (CameraProgress(),) * len(self._cameras)
        return tuple(
            camera.name
            for camera, sent, done in zip(self._cameras, self._sent, progress, strict=True)
            if done.serial < sent
        )

    def _may_send(self, frame: FrameDue, now_s: float) -> bool:
        if not self.flowing or now_s - self._sent_s[frame.camera] < LEAST_INTERVAL_S:
            return False
        self._sent_s[frame.camera] = now_s
        return True
