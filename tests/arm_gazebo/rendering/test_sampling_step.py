"""How closely the rays lie."""

import pytest

from arm_gazebo.rendering.sampling_step import AVERAGED_FRAMES, LARGEST_STEP, SamplingStep


def after(sampling: SamplingStep, duration_s: float, frames: int = AVERAGED_FRAMES) -> int:
    for _ in range(frames):
        sampling.note(duration_s)
    return sampling.step


@pytest.mark.parametrize(
    ("size", "step"), [((160, 120), 1), ((320, 240), 2), ((640, 480), 4), ((1920, 1080), 8)]
)
def test_the_first_step_goes_by_the_size(size, step):
    assert SamplingStep(*size, rate_hz=30.0).step == step


def test_too_slow_a_picture_makes_the_next_coarser_down_to_a_limit():
    sampling = SamplingStep(320, 240, rate_hz=30.0)
    assert after(sampling, 0.1) == 4
    assert after(sampling, 0.1) == 8
    assert after(sampling, 0.1) == LARGEST_STEP


def test_a_quick_picture_makes_the_next_finer():
    sampling = SamplingStep(320, 240, rate_hz=30.0)
    assert after(sampling, 0.002) == 1
    assert after(sampling, 0.002) == 1


def test_in_between_nothing_changes():
    sampling = SamplingStep(320, 240, rate_hz=30.0)
    assert after(sampling, 0.015, frames=100) == 2


def test_one_slow_picture_is_no_reason():
    sampling = SamplingStep(320, 240, rate_hz=30.0)
    sampling.note(0.1)
    assert after(sampling, 0.012, AVERAGED_FRAMES - 1) == 2


def test_a_change_is_not_taken_back_at_once():
    sampling = SamplingStep(320, 240, rate_hz=30.0)
    after(sampling, 0.030)
    assert after(sampling, 0.030 / 4, frames=100) == 4
