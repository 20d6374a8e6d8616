"""Noise of camera images and depth."""

from dataclasses import replace

import numpy as np
import pytest

from arm_gazebo.camera.drawing import CameraNoise, NoiseBank
from arm_gazebo.sensors.camera import CameraSensor


def sensor(stddev: float = 0.007, mean: float = 0.0, name: str = "camera") -> CameraSensor:
    return CameraSensor(name, "l", "f", width=200, height=150, noise_stddev=stddev, noise_mean=mean)


def noisy(bank: NoiseBank, frame: int, level: int = 128) -> np.ndarray:
    picture = np.full((150, 200, 3), level, np.uint8)
    bank.add_to(picture, frame)
    return picture


def test_mean_and_standard_deviation():
    picture = noisy(NoiseBank(sensor(0.02, 0.05), seed=1), 0).astype(float)
    assert picture.mean() == pytest.approx(128 + 0.05 * 255, abs=0.1)
    # Rounding to whole values adds a variance of 1/12.
    assert picture.std() == pytest.approx(np.hypot(0.02 * 255, 12**-0.5), rel=0.02)


def test_the_same_seed_and_frame_give_the_same_noise():
    first, second = (noisy(NoiseBank(sensor(), seed=5), 17) for _ in range(2))
    np.testing.assert_array_equal(first, second)


@pytest.mark.parametrize(
    ("other", "seed", "frame"), [("camera", 5, 18), ("camera", 6, 17), ("other", 5, 17)]
)
def test_another_frame_seed_or_camera_gives_other_noise(other, seed, frame):
    first = noisy(NoiseBank(sensor(), seed=5), 17)
    second = noisy(NoiseBank(sensor(name=other), seed=seed), frame)
    assert np.mean(first == second) < 0.5


def test_frames_are_uncorrelated():
    bank = NoiseBank(sensor(), seed=5)
    a, b = (noisy(bank, frame).astype(float).ravel() for frame in (1, 2))
    assert abs(np.corrcoef(a, b)[0, 1]) < 0.02


@pytest.mark.parametrize("level", [0, 255])
def test_values_saturate(level):
    picture = noisy(NoiseBank(sensor(0.1), seed=1), 0, level)
    assert abs(picture.astype(int) - level).max() < 200


def test_a_negative_seed_is_a_seed():
    assert noisy(NoiseBank(sensor(), seed=-1), 0).std() > 0


def drawn(camera: CameraSensor) -> tuple[np.ndarray, np.ndarray]:
    """Return a grey picture and a depth of 1 m with the camera's noise."""
    noise = CameraNoise(camera, seed=1)
    picture, depth = np.full((150, 200, 3), 128, np.uint8), np.ones((150, 200), np.float32)
    noise.add_to_picture(picture, 0)
    noise.add_to_depth(depth, 0)
    return picture, depth


def test_a_camera_without_noise_is_exact():
    picture, depth = drawn(sensor(0.0))
    assert (picture == 128).all()
    assert (depth == 1.0).all()


def test_a_mean_alone_is_noise():
    picture, depth = drawn(sensor(0.0, mean=0.1))
    assert (picture == 128 + 26).all()
    assert depth == pytest.approx(1.1)


@pytest.mark.parametrize("topics", [{"depth_topics": ("d",)}, {"image_topics": ("i",)}, {}])
def test_noise_reaches_colours_and_distances(topics):
    picture, depth = drawn(replace(sensor(0.02, 0.05), **topics))
    assert picture.std() == pytest.approx(np.hypot(0.02 * 255, 12**-0.5), rel=0.02)
    # In m: the same number.
    assert depth.mean() == pytest.approx(1.05, abs=1e-3)
    assert depth.std() == pytest.approx(0.02, rel=0.02)
