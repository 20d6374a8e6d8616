"""Draws the frames of cameras, with their noise and their limits."""

import zlib
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from arm_gazebo.camera.depth_image import mark_limits
from arm_gazebo.sensors.camera import CameraSensor

if TYPE_CHECKING:
    import mujoco

    from arm_gazebo.rendering.renderer import Renderer


SPARE_SAMPLES = 1 << 20
"""Extra length of the bank beyond one image, which is the number of different noise images."""
FULL_RANGE = 255.0


class NoiseBank:
    """Precomputed rows of noise; each frame uses another section of them. One thread.

    The section depends only on the seed, the camera's name and the frame's number, so the same
    run gives the same images. Fresh noise for an 800x800 image would take 40 ms; this takes well
    under 1 ms.
    """

    def __init__(self, sensor: CameraSensor, seed: int) -> None:
        """Compute the bank of a camera: 6 bytes per pixel plus 2 MB, and 0.1 s for 800x800."""
        import cv2

        self._add, self._subtract = cv2.add, cv2.subtract
        self._key = _noise_key(sensor, seed)
        size = sensor.width * sensor.height * 3
        noise = np.random.default_rng(self._key).standard_normal(
            size + SPARE_SAMPLES, dtype=np.float32
        )
        noise *= sensor.noise_stddev * FULL_RANGE
        noise += sensor.noise_mean * FULL_RANGE
        np.rint(noise, out=noise)
        # Two rows, because bytes are unsigned; adding and subtracting saturates correctly.
        self._brighter = np.clip(noise, 0, FULL_RANGE).astype(np.uint8)
        self._darker = np.clip(-noise, 0, FULL_RANGE).astype(np.uint8)

    def add_to(self, picture: NDArray[np.uint8], frame_number: int) -> None:
        """Add a frame's noise to a picture (height, width, 3) in place; values saturate."""
        start = self._start(frame_number)
        flat = picture.reshape(1, -1)
        section = slice(start, start + picture.size)
        self._add(flat, self._brighter[np.newaxis, section], dst=flat)
        self._subtract(flat, self._darker[np.newaxis, section], dst=flat)

    def _start(self, frame_number: int) -> int:
        mixed = np.random.SeedSequence((*self._key, frame_number)).generate_state(1)
        return int(mixed[0]) % SPARE_SAMPLES


def _noise_key(sensor: CameraSensor, seed: int) -> tuple[int, int]:
    """Return what distinguishes the noise of a camera in a run."""
    return zlib.crc32(sensor.name.encode()), seed & (2**64 - 1)


class CameraNoise:
    """The noise of one camera's pictures and distances; nothing without noise. One thread.

    It depends only on the seed, the camera's name and the frame's number. What is not drawn costs
    nothing: a bank is computed with the first picture.
    """

    def __init__(self, sensor: CameraSensor, seed: int) -> None:
        self._sensor, self._seed = sensor, seed
        self._is_silent = sensor.noise_stddev == 0.0 and sensor.noise_mean == 0.0
        self._bank: NoiseBank | None = None
        self._key = _noise_key(sensor, seed)

    def add_to_picture(self, picture: NDArray[np.uint8], frame_number: int) -> None:
        """Add a frame's noise to a picture (height, width, 3), in place."""
        if not self._is_silent:
            self._bank = self._bank or NoiseBank(self._sensor, self._seed)
            self._bank.add_to(picture, frame_number)

    def add_to_depth(self, depth: NDArray[np.float32], frame_number: int) -> None:
        """Add a frame's noise in m to distances (height, width), in place."""
        if not self._is_silent:
            random = np.random.default_rng((*self._key, frame_number))
            mean, stddev = (
                np.float32(self._sensor.noise_mean),
                np.float32(self._sensor.noise_stddev),
            )
            depth += mean + stddev * random.standard_normal(depth.shape, dtype=np.float32)


class FrameDrawing:
    """Draws frames by a renderer that is opened with the first model. One thread."""

    def __init__(
        self, sensors: Sequence[CameraSensor], open_renderer: "Callable[[], Renderer]", seed: int
    ) -> None:
        """Prepare without MuJoCo and OpenGL; the first wanted frame calls `open_renderer`."""
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
