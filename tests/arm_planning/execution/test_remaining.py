import numpy as np
import pytest

from arm_planning.execution.remaining import remaining
from arm_planning.robot.model import PlanningLimits
from arm_planning.timing.driven_spline import DrivenSpline
from arm_planning.timing.parameterize import parameterize

WHOLE = parameterize(
    [[0.0, 0.0], [1.0, 0.2], [0.5, 1.0]],
    [PlanningLimits(-3.0, 3.0, 1.0, 2.0)] * 2,
    joints=("a", "b"),
)


@pytest.mark.parametrize("time_s", [0.37, float(WHOLE.times_s[5])])
def test_the_curve_ahead_stays_the_same(time_s):
    ahead = remaining(WHOLE, time_s)
    assert ahead.duration_s == pytest.approx(WHOLE.duration_s - time_s)
    assert (np.diff(ahead.times_s) > 0.0).all()
    times = np.linspace(0.0, ahead.duration_s, 200)
    found = DrivenSpline.of(ahead).sample(times)
    expected = DrivenSpline.of(WHOLE).sample(times + time_s)
    assert found[0] == pytest.approx(expected[0], abs=1e-9)
    assert found[1] == pytest.approx(expected[1], abs=1e-6)


def test_a_point_just_ahead_is_left_out():
    ahead = remaining(WHOLE, float(WHOLE.times_s[5]) - 1e-10)
    assert np.diff(ahead.times_s).min() > 1e-4


def test_before_the_start_everything_is_ahead():
    assert remaining(WHOLE, -1.0) is WHOLE


def test_after_the_end_the_last_point_is_left():
    ahead = remaining(WHOLE, 99.0)
    assert ahead.positions == pytest.approx(WHOLE.positions[-1:])
    assert ahead.duration_s == 0.0
