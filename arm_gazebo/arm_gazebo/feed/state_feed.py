"""Hands states of the simulation to a child process, and keeps that process alive."""

import os
import threading
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import mujoco
import numpy as np

from arm_gazebo.errors import CameraError
from arm_gazebo.feed.channel import FeedEnd
from arm_gazebo.feed.schedule import FrameDue
from arm_gazebo.feed.snapshot import CameraSnapshot

MODEL_FILE_NAME = "camera-model"
FRAMING_BYTES = 4096
"""What a snapshot has beside positions, generously."""


class StateReader(Protocol):
    """Starts and ends the process that reads the states; one thread at a time."""

    def start(self, socket_fd: int) -> None:
        """Start a process that inherits this socket."""
        ...

    def start_again_due(self, backends_tried: Sequence[str], /) -> bool:
        """Return whether the process has died and is to be started again now."""
        ...

    def end(self) -> None:
        """Wait until the process has ended, whose socket is closed already."""
        ...


class StateFeed:
    """The simulation's side of one process that shows it. Nothing there reaches the physics.

    States go out in small datagrams that never wait: where the process cannot follow, they are
    lost. A process that starts gets the model first.

    `start`, `set_model`, then `send` at some ticks and `supervise` now and then; `close`.
    """

    def __init__(self, reader: StateReader) -> None:
        """Prepare; nothing is started, but `close` is needed from here on."""
        self._reader = reader
        self._channel = FeedEnd()
        self._lock = threading.Lock()
        self._version = 0
        self._model_file: int | None = None
        # While this is set the child knows the model, and the loop thread sends states of it.
        self._flowing = False
        self._closed = False

    @property
    def flowing(self) -> bool:
        """Whether the process knows the model, so that it can make something of states."""
        return self._flowing

    def start(self) -> None:
        """Start the process. It needs no model yet: start it early, then `set_model`.

        Call it from the main thread: when the thread that starts a process ends, so does the
        process.
        """
        with self._lock:
            self._reader.start(self._channel.remote_fd)

    def set_model(self, model: mujoco.MjModel) -> None:
        """Show this model from the next state on; call it before the loop starts.

        Raises:
            CameraError: the model's state is too large to send.
        """
        self.prepare(model).show()

    def prepare(self, model: mujoco.MjModel) -> "PreparedModel":
        """Return a model to be shown later; any thread. Takes some ms: it is copied.

        Raises:
            CameraError: the model's state is too large to send.
        """
        state_bytes = (model.nq + 7 * model.nmocap) * 8 + FRAMING_BYTES
        if state_bytes > self._channel.largest_message:
            raise CameraError(
                f"a state of this model has {state_bytes} bytes, too many for the cameras; "
                f"at most {self._channel.largest_message} can be sent"
            )
        return PreparedModel(self, _compiled(model))

    def show(self, file: int) -> None:
        """Show the compiled model of a file, which is closed in time; see `PreparedModel`."""
        with self._lock:
            if self._closed:
                os.close(file)
                return
            self._flowing = False
            if self._model_file is not None:
                os.close(self._model_file)
            self._model_file = file
            self._version += 1
            self._offer_model()

    def send(self, time_s: float, frames: tuple[FrameDue, ...], data: mujoco.MjData) -> None:
        """Send a state; loop thread only, and only while `flowing`. Never waits.

        Args:
            time_s: simulation time of the state.
            frames: pictures to take of it.
            data: the state.
        """
        self._channel.send_snapshot(
            CameraSnapshot(
                self._version, time_s, frames, data.qpos, data.mocap_pos, data.mocap_quat
            )
        )

    def supervise(self) -> None:
        """Start the process again if it has died and is to live; call it about once a second.

        Not on the loop thread: starting a process takes some ms. See `start` about the thread.
        """
        with self._lock:
            if self._closed:
                return
            if self._reader.start_again_due(self._channel.backends_tried()):
                self._flowing = False
                # What the dead one has not read would come before the model.
                self._channel.discard_unread()
                self._reader.start(self._channel.remote_fd)
            if not self._flowing:
                self._offer_model()

    def close(self) -> None:
        """End the process and wait for it, some seconds at most; idempotent. Any thread."""
        with self._lock:
            self._flowing = False
            if self._closed:
                return
            self._closed = True
            self._channel.shut_down()
            self._reader.end()
            # Last: a loop that is still in its tick may be sending.
            self._channel.close()
            if self._model_file is not None:
                os.close(self._model_file)

    def _offer_model(self) -> None:
        if self._model_file is not None:
            self._channel.discard_unread()
            self._flowing = self._channel.send_model(self._version, self._model_file)


@dataclass(frozen=True, slots=True)
class PreparedModel:
    """A model that one feed can show at once."""

    _feed: StateFeed
    _file: int

    def show(self) -> None:
        """Show it from the next state on; on the loop thread, where it swaps the model."""
        self._feed.show(self._file)

    def discard(self) -> None:
        """Free it; it will not be shown."""
        os.close(self._file)


def _compiled(model: mujoco.MjModel) -> int:
    """Return the descriptor of an unnamed file in memory that holds the compiled model."""
    content = np.empty(mujoco.mj_sizeModel(model), np.uint8)
    mujoco.mj_saveModel(model, None, content)
    file = os.memfd_create(MODEL_FILE_NAME)
    with open(file, "wb", closefd=False) as stream:
        stream.write(content.data)
    return file
