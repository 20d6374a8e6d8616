"""Gaussian noise for distances."""

import zlib

import numpy as np
from numpy.typing import NDArray

from arm_gazebo.sensors.camera import CameraSensor


class DepthNoise:
    """Noise of a camera that shows distances only. One thread.

    As a picture's, it depends on the seed, the camera's name and the frame's number alone.
    """

    def __init__(self, sensor: CameraSensor, seed: int) -> None:
        self._key = (zlib.crc32(sensor.name.encode()), seed & (2**64 - 1))
        self._mean = np.float32(sensor.noise_mean)
        self._stddev = np.float32(sensor.noise_stddev)

    def add_to(self, depth: NDArray[np.float32], frame_number: int) -> None:
        """Add a frame's noise in m to distances (height, width), in place."""
        random = np.random.default_rng((*self._key, frame_number))
        depth += self._mean + self._stddev * random.standard_normal(depth.shape, dtype=np.float32)
