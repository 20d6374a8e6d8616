"""Draws the frames of cameras, with their noise and their limits."""

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from arm_gazebo.camera.depth_image import mark_limits
from arm_gazebo.camera.noise import CameraNoise
from arm_gazebo.sensors.camera import CameraSensor

if TYPE_CHECKING:
    import mujoco

    from arm_gazebo.rendering.renderer import Renderer


class FrameDrawing:
    """Draws frames by a renderer that is opened with the first model. One thread."""

    def __init__(
        self, sensors: Sequence[CameraSensor], open_renderer: "Callable[[], Renderer]", seed: int
    ) -> None:
        """Prepare without MuJoCo and OpenGL.

        Args:
            sensors: the cameras.
            open_renderer: called once, when the first frame is wanted.
            seed: seed of the noise.
        """
        self._sensors = tuple(sensors)
        self._open_renderer = open_renderer
        self._seed = seed
        self._renderer: Renderer | None = None
        self._noises: dict[int, CameraNoise] = {}

    @property
    def backend(self) -> str:
        """Name of the render backend; "none" before the first model."""
        return "none" if self._renderer is None else self._renderer.backend

    def show(self, model: "mujoco.MjModel") -> None:
        """Draw this model from now on. The renderer owns it and may modify it."""
        if self._renderer is None:
            self._renderer = self._open_renderer()
        self._renderer.set_model(model)

    def draw(
        self,
        data: "mujoco.MjData",
        camera: int,
        number: int,
        picture: NDArray[np.uint8] | None,
        depth: NDArray[np.float32] | None,
    ) -> None:
        """Draw one frame of the shown model.

        Args:
            data: state with up-to-date frames of geoms, cameras and lights.
            camera: index of the camera.
            number: number of the frame, which selects its noise.
            picture: (height, width, 3) RGB, overwritten; None for no picture.
            depth: (height, width) in m, overwritten; None for no depth.
        """
        assert self._renderer is not None
        sensor = self._sensors[camera]
        self._renderer.render(data, sensor, picture, depth)
        if camera not in self._noises:
            self._noises[camera] = CameraNoise(sensor, self._seed)
        noise = self._noises[camera]
        if depth is not None:
            noise.add_to_depth(depth, number)
            mark_limits(depth, sensor)
        if picture is not None:
            noise.add_to_picture(picture, number)

    def reseed(self, seed: int) -> None:
        """Draw the noise of another run from now on."""
        self._seed = seed
        self._noises.clear()

    def close(self) -> None:
        """Free the renderer."""
        if self._renderer is not None:
            self._renderer.close()
            self._renderer = None
