"""A pose that exists is complete and finite."""

import math

import pytest

from arm_controller.errors import PoseError
from arm_controller.pose import JointPose

JOINTS = ("j0", "j1", "j2", "j3")


def test_integers_are_as_good_as_floats():
    assert JointPose.of(JOINTS, [1, 0, 0.5, -2]).positions == (1.0, 0.0, 0.5, -2.0)


def test_shows_six_decimals():
    assert (
        str(JointPose.of(JOINTS, [0.4, -0.1, 0.5, 0.4]))
        == "[0.400000, -0.100000, 0.500000, 0.400000]"
    )


@pytest.mark.parametrize("values", [[], [1.0, 2.0, 3.0], [0.0] * 5])
def test_refuses_a_wrong_length_and_names_the_joints(values):
    with pytest.raises(PoseError, match=f"joints j0, j1, j2, j3; {len(values)} were given"):
        JointPose.of(JOINTS, values)


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_refuses_what_is_not_finite_and_names_the_joint(value):
    with pytest.raises(PoseError, match="joint 'j2' cannot go to"):
        JointPose.of(JOINTS, [0.0, 0.0, value, 0.0])


@pytest.mark.parametrize("value", ["0.5", None, True, [0.5]])
def test_refuses_what_is_no_number(value):
    with pytest.raises(PoseError, match="is not one"):
        JointPose.of(JOINTS, [0.0, 0.0, value, 0.0])


def test_refuses_an_integer_beyond_any_float():
    with pytest.raises(PoseError, match="too large"):
        JointPose.of(JOINTS, [10**400, 0, 0, 0])
