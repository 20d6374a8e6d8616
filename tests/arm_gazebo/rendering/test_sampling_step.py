"""The spacing of the rays."""

import pytest

from arm_gazebo.rendering.raycast_renderer import AVERAGED_FRAMES, MAX_STEP, SamplingStep


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
