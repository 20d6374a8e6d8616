"""Sends states of the simulation to a child process, and restarts that process when it dies."""

import os
import threading
from collections.abc import Sequence
from typing import Protocol

import mujoco
import numpy as np

from arm_gazebo.errors import CameraError
from arm_gazebo.feed.schedule import FrameDue
from arm_gazebo.feed.snapshot import CameraSnapshot
from arm_gazebo.feed.socket_pair import CameraProgress, FeedEnd
from arm_node.frozen import frozen

MODEL_FILE_NAME = "camera-model"
FRAMING_BYTES = 4096
"""Generous bound on the size of a snapshot without its positions."""


class _StateReader(Protocol):
    """Starts and ends the process that reads the states. Called from one thread at a time."""

    def start(self, socket_fd: int) -> None:
        """Start a process that inherits this socket."""
        ...

    def start_again_due(self, backends_tried: Sequence[str], /) -> bool:
        """Return whether the process has died and should be restarted now."""
        ...

    def end(self) -> None:
        """Wait for the process to end after its socket was closed."""
        ...


class StateFeed:
    """The simulation's side of one process that shows it.

    States are sent as small datagrams without waiting; if the process cannot keep up, they are
    lost. A process that starts receives the model first. A fault of the process never affects the
    physics.

    Call `start` and `set_model`, then `send` at each due tick and `supervise` about once a second,
    and finally `close`.

    Attributes:
        progress: what the process last reported about its frames, one for each camera; any thread.
        version: number of the model; states of an earlier one may have been discarded.
        flowing: whether the process has received the model and so can use states.
    """

    def __init__(self, reader: _StateReader) -> None:
        """Open the connection without starting the process; `close` is required afterwards."""
        self._reader = reader
        self._channel = FeedEnd()
        self._lock = threading.Lock()
        self.progress: tuple[CameraProgress, ...] = ()
        self._tried: list[str] = []
        self.version = 0
        self._model_file: int | None = None
        # While this is set the child has the model, and the loop thread sends its states.
        self.flowing = False
        self._closed = False

    def start(self, model: mujoco.MjModel | None = None) -> None:
        """Start the process, and show a model. Start it early: it needs none before `set_model`.

        Call it from the main thread: the process ends when the thread that started it ends.

        Raises:
            CameraError: see `prepare`, if a model is given.
        """
        with self._lock:
            self._reader.start(self._channel.remote_fd)
        if model is not None:
            self.set_model(model)

    def set_model(self, model: mujoco.MjModel) -> None:
        """Show this model from the next state on. Call it before the loop starts.

        Raises:
            CameraError: see `prepare`.
        """
        self.prepare(model).show()

    def prepare(self, model: mujoco.MjModel) -> "PreparedModel":
        """Return a copy of the model to show later. Any thread; the copy takes some ms.

        Raises:
            CameraError: the model's state is too large to send.
        """
        state_bytes = (model.nq + 7 * model.nmocap) * 8 + FRAMING_BYTES
        if state_bytes > self._channel.largest_message:
            raise CameraError(
                f"a state of this model has {state_bytes} bytes, too many for the cameras; "
                f"at most {self._channel.largest_message} can be sent"
            )
        return PreparedModel(self, compiled_model(model))

    def show(self, file: int) -> None:
        """Show the compiled model of a file and take over its descriptor; see `PreparedModel`."""
        with self._lock:
            if self._closed:
                os.close(file)
                return
            self.flowing = False
            if self._model_file is not None:
                os.close(self._model_file)
            self._model_file = file
            self.version += 1
            self._offer_model()

    def send(self, time_s: float, frames: tuple[FrameDue, ...], data: mujoco.MjData) -> bool:
        """Send a state with the camera frames to render from it; return False if it is lost.

        Never waits. Loop thread only, and only while `flowing`.
        """
        return self._channel.send_snapshot(CameraSnapshot.of(data, time_s, self.version, frames))

    def supervise(self) -> None:
        """Restart the process if it has died and should run. Call it about once a second.

        Never call it on the loop thread, because starting a process takes some ms. `start` says
        which thread to use.
        """
        with self._lock:
            if self._closed:
                return
            self._hear()
            backends, self._tried = self._tried, []
            if self._reader.start_again_due(backends):
                self.flowing = False
                self.progress = ()
                # Messages that the dead process left unread would arrive before the model.
                self._channel.discard_unread()
                self._reader.start(self._channel.remote_fd)
            if not self.flowing:
                self._offer_model()

    def hear(self, timeout_s: float) -> None:
        """Wait until `progress` changes; not on the loop thread, and not after `close`."""
        self._channel.wait_for_answers(timeout_s)
        with self._lock:
            if not self._closed:
                self._hear()

    def close(self) -> None:
        """End the process and wait some seconds at most for it. Idempotent; any thread."""
        with self._lock:
            self.flowing = False
            if self._closed:
                return
            self._closed = True
            self._channel.shut_down()
            self._reader.end()
            # Closed last, because a loop in the middle of its tick may still be sending.
            self._channel.close()
            if self._model_file is not None:
                os.close(self._model_file)

    def _hear(self) -> None:
        answers = self._channel.answers()
        self._tried += answers.backends
        self.progress = answers.progress or self.progress

    def _offer_model(self) -> None:
        if self._model_file is not None:
            self._channel.discard_unread()
            self.flowing = self._channel.send_model(self.version, self._model_file)


@frozen
class PreparedModel:
    """A model that a feed can show without delay."""

    _feed: StateFeed
    _file: int

    def show(self) -> None:
        """Show the model from the next state on. Call it where the loop thread swaps the model."""
        self._feed.show(self._file)

    def discard(self) -> None:
        """Free the model without showing it."""
        os.close(self._file)


def compiled_model(model: mujoco.MjModel) -> int:
    """Return the descriptor of an unnamed file in memory that holds the compiled model."""
    content = np.empty(mujoco.mj_sizeModel(model), np.uint8)
    mujoco.mj_saveModel(model, None, content)
    file = os.memfd_create(MODEL_FILE_NAME)
    with open(file, "wb", closefd=False) as stream:
        stream.write(content.data)
    return file
