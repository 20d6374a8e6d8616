"""Ray casting: the spacing of the rays, brightness of surfaces, images from few samples."""

import mujoco
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from arm_gazebo.rendering.raycast_renderer import (
    AVERAGED_FRAMES,
    MAX_STEP,
    Lighting,
    SamplingStep,
    fill_picture,
)


def after(sampling: SamplingStep, duration_s: float, frames: int = AVERAGED_FRAMES) -> int:
    for _ in range(frames):
        sampling.note(duration_s)
    return sampling.step


@pytest.mark.parametrize(
    ("size", "step"), [((160, 120), 1), ((320, 240), 2), ((640, 480), 4), ((1920, 1080), 8)]
)
def test_the_first_step_depends_on_the_size(size, step):
    assert SamplingStep(*size, rate_hz=30.0).step == step


def test_too_slow_a_picture_makes_the_next_coarser_down_to_a_limit():
    sampling = SamplingStep(320, 240, rate_hz=30.0)
    assert after(sampling, 0.1) == 4
    assert after(sampling, 0.1) == 8
    assert after(sampling, 0.1) == MAX_STEP


def test_a_quick_picture_makes_the_next_finer():
    sampling = SamplingStep(320, 240, rate_hz=30.0)
    assert after(sampling, 0.002) == 1
    assert after(sampling, 0.002) == 1


def test_in_between_nothing_changes():
    sampling = SamplingStep(320, 240, rate_hz=30.0)
    assert after(sampling, 0.015, frames=100) == 2


def test_one_slow_image_does_not_change_the_step():
    sampling = SamplingStep(320, 240, rate_hz=30.0)
    sampling.note(0.1)
    assert after(sampling, 0.012, AVERAGED_FRAMES - 1) == 2


def test_a_change_is_not_taken_back_at_once():
    sampling = SamplingStep(320, 240, rate_hz=30.0)
    after(sampling, 0.030)
    assert after(sampling, 0.030 / 4, frames=100) == 4


UP = np.array([[0.0, 0.0, 1.0]])
ORIGIN = np.zeros((1, 3))


def brightness(light: str, point: np.ndarray = ORIGIN, normal: np.ndarray = UP, head: str = ""):
    model = mujoco.MjModel.from_xml_string(
        f"<mujoco><visual><headlight {head or 'active=' + repr('0')}/></visual>"
        f"<worldbody>{light}</worldbody></mujoco>"
    )
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    lighting = Lighting(model, data, np.array([0.0, 0.0, -1.0]))
    return lighting.brightness(np.asarray(point), np.asarray(normal))[0]


def test_no_light_is_dark():
    np.testing.assert_array_equal(brightness(""), 0.0)


def test_the_head_light_shines_along_the_view():
    head = 'ambient=".1 .2 .3" diffuse=".4 .4 .4"'
    np.testing.assert_allclose(brightness("", head=head), [0.5, 0.6, 0.7], rtol=1e-6)
    away = brightness("", normal=-UP, head=head)
    np.testing.assert_allclose(away, [0.1, 0.2, 0.3], rtol=1e-6)


@pytest.mark.parametrize(("angle_deg", "share"), [(0, 1.0), (60, 0.5), (120, 0.0)])
def test_a_directional_light_follows_lamberts_law(angle_deg, share):
    light = '<light type="directional" dir="0 0 -1" diffuse=".8 .8 .8"/>'
    angle = np.radians(angle_deg)
    tilted = np.array([[np.sin(angle), 0.0, np.cos(angle)]])
    np.testing.assert_allclose(brightness(light, normal=tilted), 0.8 * share, atol=1e-6)


def test_a_point_light_weakens_with_distance():
    light = '<light type="point" pos="0 0 2" diffuse="1 1 1" attenuation="0 0 1"/>'
    np.testing.assert_allclose(brightness(light), 0.25, rtol=1e-6)


@pytest.mark.parametrize(("x", "lit"), [(0.0, True), (1.9, False)])
def test_a_spot_light_ends_at_its_cone(x, lit):
    light = '<light type="spot" pos="0 0 2" dir="0 0 -1" cutoff="30" diffuse="1 1 1"/>'
    assert (brightness(light, point=np.array([[x, 0.0, 0.0]])).max() > 0.5) == lit


def test_a_light_that_is_off_gives_nothing():
    light = '<light active="false" type="directional" dir="0 0 -1" ambient="1 1 1"/>'
    np.testing.assert_array_equal(brightness(light), 0.0)


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
