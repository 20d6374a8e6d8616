"""The main work of the camera process: simulation's messages become images, and are counted."""

import os
import threading
import time
from collections import deque
from collections.abc import Callable, Iterable, Sequence
from itertools import chain
from typing import TYPE_CHECKING, Protocol

import numpy as np
from numpy.typing import NDArray

from arm_gazebo.camera.drawing import FrameDrawing
from arm_gazebo.feed.schedule import FrameDue
from arm_gazebo.feed.snapshot import CameraSnapshot
from arm_gazebo.feed.socket_pair import CameraProgress, ModelMessage
from arm_gazebo.sensors.camera import CameraSensor
from arm_node.frozen import frozen

if TYPE_CHECKING:
    from arm_gazebo.rendering.renderer import Renderer
    from arm_gazebo.rendering.scene import RenderScene


BACKLOG = 2
"""Limit on the pending frames of one camera: a short stall loses no frame, and a long one is not
caught up."""


class FrameSink(Protocol):
    """Publishes one camera's images and depth."""

    def wants_picture(self) -> bool:
        """Return whether the colour image has subscribers now."""
        ...

    def wants_depth(self) -> bool:
        """Return whether the depth has subscribers now."""
        ...

    @property
    def picture(self) -> NDArray[np.uint8]:
        """The (height, width, 3) array to draw into, always the same one."""
        ...

    @property
    def depth(self) -> NDArray[np.float32] | None:
        """The (height, width) array for the depth; None for a camera without depth."""
        ...

    def publish_info(self, time_s: float) -> None:
        """Publish the camera info, stamped with the time of a state."""
        ...

    def publish_picture(self, time_s: float) -> None:
        """Publish the content of `picture`, stamped with the time of its state."""
        ...

    def publish_depth(self, time_s: float) -> None:
        """Publish the content of `depth`, stamped with the time of its state."""
        ...


@frozen
class CameraReport:
    """The figures of a camera over one time window.

    Attributes:
        achieved: fraction of the wanted frames that were rendered, 0..1; None if none was wanted.
        rendered: number of frames rendered since the start.
        dropped: number of due frames since the start that were lost for lack of time.
        render_s: mean time in s to render a frame; None if none was rendered.
    """

    achieved: float | None
    rendered: int
    dropped: int
    render_s: float | None


class CameraStatistics:
    """Counts one camera's frames. Any thread."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._arrived = -1
        self._last: FrameDue | None = None
        self._rendered = 0
        self._dropped = 0
        self._start_window()

    def count_arrived(self, frame: FrameDue) -> None:
        """Note a frame that may still be passed over for a newer one."""
        with self._lock:
            self._arrived = frame.serial

    def count_due(self, frame: FrameDue, wanted: bool) -> None:
        """Count a frame that arrived, and the frames lost before it."""
        with self._lock:
            last, self._last = self._last, frame
            steps = 1
            if last is not None:
                self._dropped += max(frame.serial - last.serial - 1, 0)
                # The difference is negative if time jumped back.
                steps = max(frame.number - last.number, 1)
            if wanted:
                self._window_wanted += steps

    def count_rendered(self, duration_s: float) -> None:
        """Count a rendered frame."""
        with self._lock:
            self._rendered += 1
            self._window_rendered += 1
            self._window_render_s += duration_s

    def progress(self) -> CameraProgress:
        """Return the figures since the start."""
        with self._lock:
            return CameraProgress(self._arrived, self._rendered, self._dropped)

    def report(self) -> CameraReport:
        """Return the figures and start a new window."""
        with self._lock:
            wanted, rendered = self._window_wanted, self._window_rendered
            report = CameraReport(
                achieved=min(rendered / wanted, 1.0) if wanted else None,
                rendered=self._rendered,
                dropped=self._dropped,
                render_s=self._window_render_s / rendered if rendered else None,
            )
            self._start_window()
        return report

    def _start_window(self) -> None:
        self._window_wanted = 0
        self._window_rendered = 0
        self._window_render_s = 0.0


class CameraPipeline:
    """Renders the newest state for each camera that has subscribers. One thread.

    MuJoCo and OpenGL are loaded in this thread when the first image is wanted, so a simulation
    without camera subscribers pays for neither.

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
        """Connect cameras, in the order of the frames' indices, with the publisher of each.

        `open_renderer` is called once, when the first image is wanted.
        """
        self.time_s = 0.0
        self.statistics = tuple(CameraStatistics() for _ in sensors)
        self._sensors = tuple(sensors)
        self._sinks = tuple(sinks)
        self._drawing = FrameDrawing(sensors, open_renderer, seed)
        self._model: ModelMessage | None = None
        self._scene: RenderScene | None = None
        self._posed: CameraSnapshot | None = None

    @property
    def backend(self) -> str:
        """Name of the render backend; "none" before the first image."""
        return self._drawing.backend

    def handle(self, messages: Iterable[ModelMessage | CameraSnapshot]) -> None:
        """Process messages that arrived together: all models, and each camera's newest frames."""
        newest = [deque[tuple[CameraSnapshot, FrameDue]](maxlen=BACKLOG) for _ in self._sensors]
        for message in messages:
            if isinstance(message, ModelMessage):
                self._take_model(message)
                for frames in newest:
                    frames.clear()
                continue
            for frame in message.frames:
                self.statistics[frame.camera].count_arrived(frame)
                if self._model is not None and message.model_version == self._model.version:
                    newest[frame.camera].append((message, frame))
        for snapshot, frame in chain.from_iterable(newest):
            self._take_frame(snapshot, frame)

    def close(self) -> None:
        """Free the renderer and the model."""
        self._drawing.close()
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
        scene = self._ready()
        if self._posed is not snapshot:
            scene.pose(snapshot)
            self._posed = snapshot
        self._drawing.draw(scene.data, frame.camera, frame.number, picture, depth)

    def _ready(self) -> "RenderScene":
        if self._scene is None:
            from arm_gazebo.rendering.scene import RenderScene, read_model

            assert self._model is not None
            self._scene = RenderScene(read_model(self._model.file))
            self._drawing.show(self._scene.model)
        return self._scene
