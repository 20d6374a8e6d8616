"""Pictures of the running simulation in its own process, drawn when a program asks for one."""

import copy
import logging
import math
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from arm_gazebo.camera.drawing import FrameDrawing
from arm_gazebo.errors import BackendError
from arm_gazebo.feed.snapshot import CameraSnapshot
from arm_gazebo.sensors.camera import CameraSensor

if TYPE_CHECKING:
    import mujoco

    from arm_gazebo.physics.physics import Physics
    from arm_gazebo.rendering.renderer import Renderer
    from arm_gazebo.rendering.scene import RenderScene

TOLERANCE_S = 1e-6
"""Rounding error of a time that is a sum of steps."""

logger = logging.getLogger(__name__)


class OnDemandCameras:
    """Draws what the cameras see in the present state. The simulation's thread.

    OpenGL is loaded with the first picture. A picture is the one that the camera process publishes
    at the same time, except that ray casting, which has all the time it needs, omits no pixel.

    Args:
        simulation: the simulation that contains the cameras.
        sensors: the cameras.
        backend: the render backend: auto, egl, osmesa or raycast.
        seed: seed of the noise.
    """

    def __init__(
        self, simulation: "Physics", sensors: Sequence[CameraSensor], backend: str, seed: int
    ) -> None:
        self._simulation = simulation
        self._sensors = tuple(sensors)
        self._backend = backend
        # A rate of 0: nobody waits for the next frame.
        unhurried = [replace(sensor, rate_hz=0.0) for sensor in sensors]
        self._drawing = FrameDrawing(unhurried, self._open, seed)
        self._shown: mujoco.MjModel | None = None
        self._scene: RenderScene | None = None

    def picture(self, camera: int) -> NDArray[np.uint8]:
        """Return what a camera sees: RGB, shape (height, width, 3).

        Raises:
            CameraError: there is no render backend that works.
        """
        sensor = self._sensors[camera]
        picture = np.empty((sensor.height, sensor.width, 3), np.uint8)
        self._draw(camera, picture, None)
        return picture

    def depth(self, camera: int) -> NDArray[np.float32]:
        """Return the distances along a camera's axis in m, shape (height, width).

        Distances out of the camera's range are infinite, as REP 117 requires.

        Raises:
            CameraError: there is no render backend that works.
        """
        sensor = self._sensors[camera]
        depth = np.empty((sensor.height, sensor.width), np.float32)
        self._draw(camera, None, depth)
        return depth

    def reseed(self, seed: int) -> None:
        """Draw the noise of another run from now on."""
        self._drawing.reseed(seed)

    def close(self) -> None:
        """Free the renderer; the next picture opens it again."""
        self._drawing.close()
        self._scene = self._shown = None

    def _draw(
        self, camera: int, picture: NDArray[np.uint8] | None, depth: NDArray[np.float32] | None
    ) -> None:
        scene, data = self._present_scene(), self._simulation.data
        time_s = self._simulation.time_s
        scene.pose(CameraSnapshot(0, time_s, (), data.qpos, data.mocap_pos, data.mocap_quat))
        number = math.floor((time_s + TOLERANCE_S) * self._sensors[camera].rate_hz)
        self._drawing.draw(scene.data, camera, number, picture, depth)

    def _present_scene(self) -> "RenderScene":
        """Return the scene of the simulation's present model."""
        from arm_gazebo.rendering.scene import RenderScene

        model = self._simulation.model
        if self._scene is None or self._shown is not model:
            self._scene, self._shown = RenderScene(copy.copy(model)), model
            self._drawing.show(self._scene.model)
        return self._scene

    def _open(self) -> "Renderer":
        from arm_gazebo.rendering.backend_selection import RAYCAST, backend_order, open_renderer
        from arm_gazebo.rendering.pinhole_view import drawn_size

        size = drawn_size(self._sensors)
        try:
            return open_renderer(backend_order(self._backend), *size)
        except BackendError as error:
            # No other OpenGL library can work in this process any more.
            logger.warning("%s; the images are ray-cast", error)
            return open_renderer(backend_order(RAYCAST), *size)
