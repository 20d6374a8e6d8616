"""Hands states of the simulation to the camera process, and keeps that process alive."""

import math
import os
import threading
import time
from collections.abc import Callable, Sequence

import mujoco
import numpy as np

from arm_gazebo.camera_channel import FeedEnd
from arm_gazebo.camera_process import CameraProcess
from arm_gazebo.camera_schedule import FrameDue, FrameSchedule
from arm_gazebo.camera_sensor import CameraSensor
from arm_gazebo.camera_settings import CameraSettings
from arm_gazebo.camera_snapshot import CameraSnapshot
from arm_gazebo.errors import CameraError
from arm_gazebo.rendering.backend_selection import backend_order
from arm_gazebo.rendering.renderer import camera_id

MODEL_FILE_NAME = "camera-model"
FRAMING_BYTES = 4096
"""What a snapshot has beside positions, generously."""
LEAST_INTERVAL_S = 0.002
"""Wall time between two states for one camera. A simulation that runs as fast as possible would
keep the camera process busy with more than anybody can look at."""


class CameraFeed:
    """The simulation's side of its cameras. Nothing that happens to them reaches the physics.

    Pictures are drawn and published by a child process. What is due is sent to it in small
    datagrams that never wait: where it cannot follow, frames are lost, and it counts them.

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
        self._process = make_process(settings, ros_arguments)
        self._schedule = FrameSchedule([camera.rate_hz for camera in self._cameras])
        self._channel = FeedEnd()
        self._clock = clock
        self._sent_s = [-math.inf] * len(self._cameras)
        self._lock = threading.Lock()
        self._version = 0
        self._model_file: int | None = None
        # While this is set the child knows the model, and the loop thread sends states of it.
        self._flowing = False
        self._closed = False

    def start(self, model: mujoco.MjModel | None = None) -> None:
        """Start the camera process. It needs no model yet: start it early, then `set_model`.

        Call it from the main thread: when the thread that starts a process ends, so does the
        process.

        Raises:
            CameraError: as `set_model`, where a model is given.
        """
        with self._lock:
            self._process.start(self._channel.remote_fd)
        if model is not None:
            self.set_model(model)

    def set_model(self, model: mujoco.MjModel) -> None:
        """Draw this model from the next state on.

        Call it before the loop starts, or on the loop thread where it swaps the model. Takes
        some ms: the compiled model is copied.

        Raises:
            CameraError: the model lacks one of the cameras, or its state is too large to send.
        """
        for camera in self._cameras:
            camera_id(model, camera)
        state_bytes = (model.nq + 7 * model.nmocap) * 8 + FRAMING_BYTES
        if state_bytes > self._channel.largest_message:
            raise CameraError(
                f"a state of this model has {state_bytes} bytes, too many for the cameras; "
                f"at most {self._channel.largest_message} can be sent"
            )
        file = _compiled(model)
        with self._lock:
            self._flowing = False
            if self._model_file is not None:
                os.close(self._model_file)
            self._model_file = file
            self._version += 1
            self._offer_model()

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
            mocap_poses = np.hstack((data.mocap_pos, data.mocap_quat))
            self._channel.send_snapshot(
                CameraSnapshot(self._version, time_s, frames, data.qpos, mocap_poses)
            )

    def supervise(self) -> None:
        """Start the camera process again if it has died; call it about once a second.

        Not on the loop thread: starting a process takes some ms. See `start` about the thread.
        """
        with self._lock:
            if self._closed:
                return
            if self._process.start_again_due(self._channel.backends_tried()):
                self._flowing = False
                # What the dead one has not read would come before the model.
                self._channel.discard_unread()
                self._process.start(self._channel.remote_fd)
            if not self._flowing:
                self._offer_model()

    def close(self) -> None:
        """End the camera process and wait for it, some seconds at most; idempotent. Any thread."""
        with self._lock:
            self._flowing = False
            if self._closed:
                return
            self._closed = True
            self._channel.shut_down()
            self._process.end()
            # Last: a loop that is still in its tick may be sending.
            self._channel.close()
            if self._model_file is not None:
                os.close(self._model_file)

    def _may_send(self, frame: FrameDue, now_s: float) -> bool:
        if not self._flowing or now_s - self._sent_s[frame.camera] < LEAST_INTERVAL_S:
            return False
        self._sent_s[frame.camera] = now_s
        return True

    def _offer_model(self) -> None:
        if self._model_file is not None:
            self._channel.discard_unread()
            self._flowing = self._channel.send_model(self._version, self._model_file)


def _compiled(model: mujoco.MjModel) -> int:
    """Return the descriptor of an unnamed file in memory that holds the compiled model."""
    content = np.empty(mujoco.mj_sizeModel(model), np.uint8)
    mujoco.mj_saveModel(model, None, content)
    file = os.memfd_create(MODEL_FILE_NAME)
    with open(file, "wb", closefd=False) as stream:
        stream.write(content.data)
    return file
