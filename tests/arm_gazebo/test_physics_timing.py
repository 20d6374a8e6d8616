import pytest

from arm_gazebo.errors import TimingError
from arm_gazebo.physics_timing import physics_timing


@pytest.mark.parametrize(
    ("rate_hz", "steps"), [(1, 500), (30, 17), (50, 10), (100, 5), (225, 3), (500, 1), (1000, 1)]
)
def test_step_is_the_largest_divisor_up_to_2_ms(rate_hz, steps):
    timing = physics_timing(rate_hz)
    assert timing.steps == steps
    assert timing.step_s * steps == pytest.approx(1 / rate_hz)
    assert timing.step_s <= 0.002 * (1 + 1e-6)


def test_fixed_step_that_divides_is_taken():
    assert physics_timing(100, fixed_step_s=0.001).steps == 10


def test_fixed_step_may_be_rounded_in_its_decimals():
    assert physics_timing(30, fixed_step_s=0.00196078431).steps == 17


def test_fixed_step_that_does_not_divide_is_refused():
    with pytest.raises(
        TimingError,
        match=r"step of 0\.003 s does not divide .* 0\.01 s .*100 Hz.*; 0\.00333333 s would",
    ):
        physics_timing(100, fixed_step_s=0.003)


@pytest.mark.parametrize("rate_hz", [0, -1, float("nan"), float("inf")])
def test_rate_must_be_positive(rate_hz):
    with pytest.raises(TimingError, match="update_rate must be above 0 Hz"):
        physics_timing(rate_hz)


@pytest.mark.parametrize("step_s", [0, -0.001, float("nan")])
def test_fixed_step_must_be_positive(step_s):
    with pytest.raises(TimingError, match="physics step must be above 0 s"):
        physics_timing(100, fixed_step_s=step_s)


@pytest.mark.parametrize(
    ("rate_hz", "step_s", "what"), [(1e9, None, "update_rate"), (100, 1e-9, "the physics step")]
)
def test_a_step_that_is_too_short_is_refused(rate_hz, step_s, what):
    with pytest.raises(TimingError, match=f"{what} makes physics steps shorter than 1e-06 s"):
        physics_timing(rate_hz, fixed_step_s=step_s)
