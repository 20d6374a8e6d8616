"""The cameras of the simulated robot: they draw the present state when a program asks."""

import copy
import logging
import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from arm_gazebo.camera.drawing import FrameDrawing
from arm_gazebo.errors import BackendError
from arm_gazebo.feed.snapshot import CameraSnapshot
from arm_gazebo.physics.physics import Physics
from arm_gazebo.sensors.camera import CameraSensor
from arm_sim.errors import UnknownNameError
from arm_sim.user_traceback import ends_at_the_caller

if TYPE_CHECKING:
    from arm_gazebo.rendering.renderer import Renderer
    from arm_gazebo.rendering.scene import RenderScene

TOLERANCE_S = 1e-6
"""Rounding error of a time that is a sum of steps."""

logger = logging.getLogger(__name__)

_Draw = Callable[[NDArray[np.uint8] | None, NDArray[np.float32] | None], None]
"""Draws into a picture, a depth image, or both."""


@ends_at_the_caller
class Camera:
    """One camera; it draws the present state on request.

    Attributes:
        name: its name.
        width: width of its images, in pixels.
        height: height of its images, in pixels.
        is_dark: whether something covers its lens.
    """

    def __init__(self, draw: _Draw, sensor: CameraSensor) -> None:
        self._draw = draw
        self._lens = sensor.lens
        self._rays: NDArray[np.float64] | None = None
        self.is_dark = False
        self.name = sensor.name
        self.width = sensor.width
        self.height = sensor.height

    @property
    def matrix(self) -> NDArray[np.float64]:
        """The intrinsic matrix K in pixels, shape (3, 3), as in CameraInfo.

        As in Gazebo, the centre of the first pixel is at (0.5, 0.5). OpenCV, image_geometry and
        depth_image_proc have it at (0, 0): subtract 0.5 from cx and cy for them, or all points are
        half a pixel off. `rays` has the rays themselves.
        """
        return self._lens.matrix

    @property
    def distortion(self) -> NDArray[np.float64]:
        """The coefficients k1, k2, p1, p2, k3 of CameraInfo's plumb_bob model, shape (5,)."""
        return np.array(self._lens.distortion)

    def rays(self) -> NDArray[np.float64]:
        """Return the rays through the pixels' centres, shape (height, width, 3), read-only.

        They are in the optical frame (z forward, x right, y down), and z is 1: times `depth()` they
        are the points that the camera sees, in m.
        """
        if self._rays is None:
            self._rays = np.ones((self.height, self.width, 3))
            self._rays[..., :2] = self._lens.rays(self.width, self.height)
            self._rays.setflags(write=False)
        return self._rays

    def image(self) -> NDArray[np.uint8]:
        """Return what it sees, with its noise: RGB, shape (height, width, 3).

        Raises:
            CameraError: no render backend works.
        """
        picture = np.zeros((self.height, self.width, 3), np.uint8)
        if not self.is_dark:
            self._draw(picture, None)
        return picture

    def depth(self) -> NDArray[np.float32]:
        """Return the distances along its axis in m, shape (height, width).

        Distances below the near clip are -inf, those beyond the far clip inf.

        Raises:
            CameraError: no render backend works.
        """
        depth = np.full((self.height, self.width), -np.inf, np.float32)
        if not self.is_dark:
            self._draw(None, depth)
        return depth


class RobotCameras:
    """The cameras of the robot; they share one renderer. The simulation's thread.

    OpenGL is loaded with the first picture. A picture is the one that the camera process publishes
    at the same time, except that ray casting, which has all the time it needs, omits no pixel.

    Args:
        physics: the simulation that contains the cameras.
        sensors: the cameras.
        backend: the render backend: auto, egl, osmesa or raycast.
        seed: seed of the noise.
    """

    def __init__(
        self, physics: Physics, sensors: Sequence[CameraSensor], backend: str, seed: int
    ) -> None:
        self._physics = physics
        self._sensors = tuple(sensors)
        self._backend = backend
        # A rate of 0: nobody waits for the next frame.
        unhurried = [replace(sensor, rate_hz=0.0) for sensor in sensors]
        self._drawing = FrameDrawing(unhurried, self._open, seed)
        self._shown: object = None  # The model of the scene.
        self._scene: RenderScene | None = None
        cameras = [Camera(partial(self._draw, i), sensor) for i, sensor in enumerate(sensors)]
        self._found = {
            key: camera
            for camera, sensor in zip(cameras, sensors, strict=True)
            for key in (*(topic.strip("/") for topic in sensor.topics), sensor.name)
        }

    def find(self, name: str) -> Camera:
        """Return a camera by its name, or by one of its topics.

        Raises:
            UnknownNameError: there is none of that name.
        """
        found = self._found.get(name.strip("/"))
        if found is None:
            existing = ", ".join(sensor.name for sensor in self._sensors) or "none"
            raise UnknownNameError(f"no camera '{name}'; the robot has {existing}")
        return found

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
        scene, time_s = self._present_scene(), self._physics.time_s
        scene.pose(CameraSnapshot.of(self._physics.data, time_s))
        number = math.floor((time_s + TOLERANCE_S) * self._sensors[camera].rate_hz)
        self._drawing.draw(scene.data, camera, number, picture, depth)

    def _present_scene(self) -> "RenderScene":
        """Return the scene of the simulation's present model."""
        from arm_gazebo.rendering.scene import RenderScene

        model = self._physics.model
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
