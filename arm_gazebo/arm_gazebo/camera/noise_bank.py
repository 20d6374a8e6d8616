"""Gaussian noise for pictures, cheap enough for 30 large ones a second."""

import zlib

import numpy as np
from numpy.typing import NDArray

from arm_gazebo.camera.depth_noise import DepthNoise
from arm_gazebo.sensors.camera import CameraSensor

SPARE_SAMPLES = 1 << 20
"""How much longer than a picture the bank is: so many different noises it has."""
FULL_RANGE = 255.0


class NoiseBank:
    """Long rows of noise, made once; each frame gets another stretch of them.

    Which stretch depends on the seed, the camera's name and the frame's number alone: the same
    run gives the same pictures. Fresh noise for an 800x800 picture would take 40 ms, this takes
    well under one. One thread.
    """

    def __init__(self, sensor: CameraSensor, seed: int) -> None:
        """Make the bank: 6 bytes a pixel, 2 MB more, and a tenth of a second for 800x800.

        Args:
            sensor: the camera; gives size, mean and standard deviation.
            seed: of the run; any integer.
        """
        import cv2

        self._add, self._subtract = cv2.add, cv2.subtract
        self._key = (zlib.crc32(sensor.name.encode()), seed & (2**64 - 1))
        size = sensor.width * sensor.height * 3
        noise = np.random.default_rng(self._key).standard_normal(
            size + SPARE_SAMPLES, dtype=np.float32
        )
        noise *= sensor.noise_stddev * FULL_RANGE
        noise += sensor.noise_mean * FULL_RANGE
        np.rint(noise, out=noise)
        # Two rows, for bytes have no sign and saturate in the right direction this way.
        self._brighter = np.clip(noise, 0, FULL_RANGE).astype(np.uint8)
        self._darker = np.clip(-noise, 0, FULL_RANGE).astype(np.uint8)

    def add_to(self, picture: NDArray[np.uint8], frame_number: int) -> None:
        """Add a frame's noise to a picture (height, width, 3) in place; values saturate."""
        start = self._start(frame_number)
        flat = picture.reshape(1, -1)
        stretch = slice(start, start + picture.size)
        self._add(flat, self._brighter[np.newaxis, stretch], dst=flat)
        self._subtract(flat, self._darker[np.newaxis, stretch], dst=flat)

    def _start(self, frame_number: int) -> int:
        mixed = np.random.SeedSequence((*self._key, frame_number)).generate_state(1)
        return int(mixed[0]) % SPARE_SAMPLES


def noise_for(sensor: CameraSensor, seed: int) -> NoiseBank | DepthNoise | None:
    """Return the noise of a camera, None for a camera without.

    A camera that shows both has exact distances, as Gazebo's.
    """
    if sensor.noise_stddev == 0.0 and sensor.noise_mean == 0.0:
        return None
    if sensor.measures_depth and not sensor.image_topics:
        return DepthNoise(sensor, seed)
    return NoiseBank(sensor, seed)
