"""The cameras of the simulated robot."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from arm_gazebo.camera.on_demand import OnDemandCameras
from arm_gazebo.physics.physics import Physics
from arm_gazebo.sensors.camera import CameraSensor
from arm_sim.errors import UnknownNameError
from arm_sim.user_traceback import ends_at_the_caller


@ends_at_the_caller
class Camera:
    """One camera; it draws the present state on request.

    Attributes:
        name: its name.
        width: width of its images, in pixels.
        height: height of its images, in pixels.
        is_dark: whether something covers its lens.
    """

    def __init__(self, cameras: OnDemandCameras, index: int, sensor: CameraSensor) -> None:
        self._cameras = cameras
        self._index = index
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
        if self.is_dark:
            return np.zeros((self.height, self.width, 3), np.uint8)
        return self._cameras.picture(self._index)

    def depth(self) -> NDArray[np.float32]:
        """Return the distances along its axis in m, shape (height, width).

        Distances below the near clip are -inf, those beyond the far clip inf.

        Raises:
            CameraError: no render backend works.
        """
        if self.is_dark:
            return np.full((self.height, self.width), -np.inf, np.float32)
        return self._cameras.depth(self._index)


class RobotCameras:
    """The cameras of the robot; they share one renderer, which is opened for the first picture.

    Attributes:
        names: names of the cameras.
    """

    def __init__(
        self, physics: Physics, sensors: Sequence[CameraSensor], backend: str, seed: int
    ) -> None:
        self._drawn = OnDemandCameras(physics, sensors, backend, seed)
        cameras = [Camera(self._drawn, index, sensor) for index, sensor in enumerate(sensors)]
        self.names = tuple(camera.name for camera in cameras)
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
            existing = f"the robot has {', '.join(self.names) or 'none'}"
            raise UnknownNameError(f"no camera '{name}'; {existing}")
        return found

    def reseed(self, seed: int) -> None:
        """Draw the noise of another run from now on."""
        self._drawn.reseed(seed)

    def close(self) -> None:
        """Free the renderer."""
        self._drawn.close()
