import pytest

from arm_planning.errors import PlanningError
from arm_planning.planners.pilz.cartesian_limits import CartesianLimits, cartesian_limits


def test_given_limits_replace_the_defaults():
    values = {"cartesian_limits": {"max_trans_vel": 0.5}, "cartesian_limits.max_rot_vel": 1}
    found = cartesian_limits(values)
    assert found == CartesianLimits(max_trans_vel=0.5, max_rot_vel=1.0)


def test_other_parameters_are_passed_over():
    assert cartesian_limits({"joint_limits": {"j1": {"max_velocity": 1.0}}}) == CartesianLimits()


@pytest.mark.parametrize(
    ("key", "value", "sentence"),
    [
        ("max_trans_vel", 0.0, "must be positive"),
        ("max_trans_vel", 10**400, "must be positive and finite"),
        ("max_trans_dec", 5.0, "must be negative"),
        ("max_rot_vel", float("nan"), "must be positive"),
        ("max_rot_vel", "fast", "is not a number: 'fast'"),
        ("max_trans_acc", True, "is not a number: True"),
        ("max_trans_speed", 1.0, "no limit 'cartesian_limits.max_trans_speed'"),
    ],
)
def test_limits_that_make_no_sense(key, value, sentence):
    with pytest.raises(PlanningError, match=sentence):
        cartesian_limits({"cartesian_limits": {key: value}})
