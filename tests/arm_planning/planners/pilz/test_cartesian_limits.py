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
        ("max_trans_vel", 0.0, "is 0.0; it is above 0"),
        ("max_trans_vel", 10**400, "not a finite number"),
        ("max_trans_dec", 5.0, "is 5.0; it is below 0"),
        ("max_rot_vel", float("nan"), "not a finite number"),
        ("max_rot_vel", "fast", "is 'fast', which is not a finite number"),
        ("max_trans_acc", True, "is True, which is not a finite number"),
        ("max_trans_speed", 1.0, "no limit 'cartesian_limits.max_trans_speed'"),
    ],
)
def test_limits_that_make_no_sense(key, value, sentence):
    with pytest.raises(PlanningError, match=sentence):
        cartesian_limits({"cartesian_limits": {key: value}})
