"""Images from few samples."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from arm_gazebo.rendering.raycast_renderer import fill_picture


class Source:
    """An image whose pixels can be sampled; counts the samples."""

    def __init__(self, picture: np.ndarray) -> None:
        # The picture goes on beyond its edges.
        self._picture = np.pad(picture, ((0, 16), (0, 16), (0, 0)), mode="edge")
        self.asked = 0

    def __call__(self, rows: np.ndarray, columns: np.ndarray) -> np.ndarray:
        self.asked += len(rows)
        return self._picture[rows, columns]


def filled(picture: np.ndarray, step: int) -> tuple[np.ndarray, Source]:
    source, result = Source(picture), np.zeros_like(picture)
    fill_picture(result, step, source)
    return result, source


def disc(height: int, width: int) -> np.ndarray:
    rows, columns = np.mgrid[:height, :width]
    inside = (rows - height / 2) ** 2 + (columns - width / 2) ** 2 < (height / 3) ** 2
    return np.where(inside[..., np.newaxis], [200, 40, 30], [90, 120, 160]).astype(np.uint8)


@given(
    height=st.integers(1, 40),
    width=st.integers(1, 40),
    step=st.sampled_from([1, 2, 4, 8]),
    seed=st.integers(0, 100),
)
def test_every_pixel_gets_a_colour_near_its_own_or_its_own(height, width, step, seed):
    random = np.random.default_rng(seed)
    blocks = random.integers(0, 255, (6, 6, 3), dtype=np.uint8)
    picture = np.kron(blocks, np.ones((8, 8, 1), np.uint8))[:height, :width]
    result, _ = filled(picture, step)
    assert result.shape == picture.shape
    if step == 1:
        np.testing.assert_array_equal(result, picture)


@pytest.mark.parametrize("step", [2, 4])
def test_edges_of_shapes_wider_than_the_step_are_exact(step):
    picture = disc(60, 83)
    result, source = filled(picture, step)
    np.testing.assert_array_equal(result, picture)
    assert source.asked < 0.6 * 60 * 83


def test_a_plain_picture_takes_only_the_first_samples():
    picture = np.full((65, 65, 3), 77, np.uint8)
    result, source = filled(picture, 8)
    np.testing.assert_array_equal(result, picture)
    assert source.asked == 9 * 9


def test_a_gentle_slope_is_interpolated():
    picture = np.repeat(np.arange(129, dtype=np.uint8)[np.newaxis, :, np.newaxis], 9, axis=0)
    picture = np.repeat(picture, 3, axis=2)
    result, source = filled(picture, 4)
    assert np.abs(result.astype(int) - picture).max() <= 1
    assert source.asked < picture[..., 0].size / 8
