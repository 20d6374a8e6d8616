"""From the simulation's messages to pictures: what the camera process does all day."""

import os
import time
from collections import deque
from collections.abc import Callable, Iterable, Sequence
from itertools import chain
from typing import TYPE_CHECKING, Protocol

import numpy as np
from numpy.typing import NDArray

from arm_gazebo.camera.depth_image import mark_limits
from arm_gazebo.camera.depth_noise import DepthNoise
from arm_gazebo.camera.noise_bank import NoiseBank, noise_for
from arm_gazebo.camera.statistics import CameraStatistics
from arm_gazebo.feed.channel import ModelMessage
from arm_gazebo.feed.schedule import FrameDue
from arm_gazebo.feed.snapshot import CameraSnapshot
from arm_gazebo.sensors.camera import CameraSensor

if TYPE_CHECKING:
    from arm_gazebo.rendering.renderer import Renderer
    from arm_gazebo.rendering.scene import Scene


BACKLOG = 2
"""Frames of one camera worked off at once: a short stall costs none, a long one is not redone."""


class FrameSink(Protocol):
    """Where one camera's pictures and distances go."""

    def wants_picture(self) -> bool:
        """Return whether anybody looks at the colours now."""
        ...

    def wants_depth(self) -> bool:
        """Return whether anybody looks at the distances now."""
        ...

    @property
    def picture(self) -> NDArray[np.uint8]:
        """The (height, width, 3) array to draw into, always the same one."""
        ...

    @property
    def depth(self) -> NDArray[np.float32] | None:
        """The (height, width) array for the distances; None for a camera that has none."""
        ...

    def publish_info(self, time_s: float) -> None:
        """Publish the intrinsics, stamped with the time of a state."""
        ...

    def publish_picture(self, time_s: float) -> None:
        """Publish what stands in `picture`, stamped with the time of its state."""
        ...

    def publish_depth(self, time_s: float) -> None:
        """Publish what stands in `depth`, likewise."""
        ...


class CameraPipeline:
    """Draws the newest state for each camera that somebody looks at. One thread.

    MuJoCo and OpenGL are loaded when the first picture is wanted, in this thread: a simulation
    whose cameras nobody looks at pays for neither.

    Attributes:
        statistics: one per camera, in the cameras' order; readable from any thread.
        time_s: simulation time of the newest state.
    """

    def __init__(
        self,
        sensors: Sequence[CameraSensor],
        sinks: Sequence[FrameSink],
        open_renderer: Callable[[], "Renderer"],
        seed: int = 0,
    ) -> None:
        """Connect cameras with the sinks of their pictures.

        Args:
            sensors: the cameras, in the order of the frames' indices.
            sinks: where each camera's pictures go.
            open_renderer: called once, when the first picture is wanted.
            seed: of the noise.
        """
        self.time_s = 0.0
        self.statistics = tuple(CameraStatistics() for _ in sensors)
        self._sensors = tuple(sensors)
        self._sinks = tuple(sinks)
        self._open_renderer = open_renderer
        self._seed = seed
        self._renderer: Renderer | None = None
        self._noises: dict[int, NoiseBank | DepthNoise | None] = {}
        self._model: ModelMessage | None = None
        self._scene: Scene | None = None
        self._posed: CameraSnapshot | None = None

    @property
    def backend(self) -> str:
        """Name of what draws; "none" before the first picture."""
        return "none" if self._renderer is None else self._renderer.backend

    def handle(self, messages: Iterable[ModelMessage | CameraSnapshot]) -> None:
        """Work off messages that arrived together: all models, each camera's newest frames."""
        newest = [deque[tuple[CameraSnapshot, FrameDue]](maxlen=BACKLOG) for _ in self._sensors]
        for message in messages:
            if isinstance(message, ModelMessage):
                self._take_model(message)
                for frames in newest:
                    frames.clear()
            elif self._model is not None and message.model_version == self._model.version:
                for frame in message.frames:
                    newest[frame.camera].append((message, frame))
        for snapshot, frame in chain.from_iterable(newest):
            self._take_frame(snapshot, frame)

    def close(self) -> None:
        """Free the renderer and the model."""
        if self._renderer is not None:
            self._renderer.close()
            self._renderer = None
        if self._model is not None:
            os.close(self._model.file)
            self._model = None

    def _take_model(self, message: ModelMessage) -> None:
        if self._model is not None:
            os.close(self._model.file)
        self._model = message
        self._scene = None
        self._posed = None

    def _take_frame(self, snapshot: CameraSnapshot, frame: FrameDue) -> None:
        self.time_s = snapshot.time_s
        sink = self._sinks[frame.camera]
        picture = sink.picture if sink.wants_picture() else None
        depth = sink.depth if sink.wants_depth() else None
        wanted = picture is not None or depth is not None
        self.statistics[frame.camera].count_due(frame, wanted)
        sink.publish_info(snapshot.time_s)
        if not wanted:
            return
        start_s = time.perf_counter()
        self._draw(snapshot, frame, picture, depth)
        self.statistics[frame.camera].count_rendered(time.perf_counter() - start_s)
        if picture is not None:
            sink.publish_picture(snapshot.time_s)
        if depth is not None:
            sink.publish_depth(snapshot.time_s)

    def _draw(
        self,
        snapshot: CameraSnapshot,
        frame: FrameDue,
        picture: NDArray[np.uint8] | None,
        depth: NDArray[np.float32] | None,
    ) -> None:
        renderer, scene = self._ready()
        if self._posed is not snapshot:
            scene.pose(snapshot)
            self._posed = snapshot
        sensor = self._sensors[frame.camera]
        renderer.render(scene.data, sensor, picture, depth)
        noise = self._noises.get(frame.camera)
        if frame.camera not in self._noises:
            noise = self._noises[frame.camera] = noise_for(sensor, self._seed)
        if depth is not None:
            if isinstance(noise, DepthNoise):
                noise.add_to(depth, frame.number)
            mark_limits(depth, sensor)
        if picture is not None and isinstance(noise, NoiseBank):
            noise.add_to(picture, frame.number)

    def _ready(self) -> "tuple[Renderer, Scene]":
        if self._renderer is None:
            self._renderer = self._open_renderer()
        if self._scene is None:
            from arm_gazebo.rendering.scene import Scene

            assert self._model is not None
            self._scene = Scene(self._model.file)
            self._renderer.set_model(self._scene.model)
        return self._renderer, self._scene
