"""Parameters whose exact type does not matter."""

from array import array

import pytest

from arm_controller.errors import PoseError
from arm_controller.parameter_values import (
    read_joint_names,
    read_place,
    read_pose,
    read_positive,
    read_rate,
    read_zero_or_more,
)
from arm_node.parameter_values import ParameterValueError

JOINTS = ("j0", "j1")


@pytest.mark.parametrize("value", [2, 2.0])
def test_a_number_may_be_an_integer(value):
    assert read_positive(value) == 2.0


@pytest.mark.parametrize("value", [0, -1.5, float("nan"), float("inf"), "2", True, None, [2.0]])
def test_refuses_a_value_that_is_not_a_positive_number(value):
    with pytest.raises(ParameterValueError, match=r"must be a number above 0, at most 1e\+09, not"):
        read_positive(value)


def test_zero_may_be_allowed():
    assert read_zero_or_more(0) == 0.0
    with pytest.raises(ParameterValueError, match=r"must be a number from 0 to 1e\+09, not -1"):
        read_zero_or_more(-1)


@pytest.mark.parametrize("value", [1.1e9, 2**62])
def test_a_number_that_no_timer_can_count_is_refused(value: float):
    assert read_positive(1e9) == 1e9
    with pytest.raises(ParameterValueError, match=r"must be .*, at most 1e\+09, not"):
        read_positive(value)


@pytest.mark.parametrize("value", [0, 1e-9, 20])
def test_a_rate_may_be_zero_and_slow(value: float):
    assert read_rate(value) == value


@pytest.mark.parametrize("value", [1e-10, 5e-324])
def test_a_rate_too_low_for_a_timer_is_refused(value: float):
    with pytest.raises(ParameterValueError, match="must be 0 or at least 1e-09, not"):
        read_rate(value)


@pytest.mark.parametrize("value", [[1, 0.5], array("d", [1, 0.5]), "[1, 0.5]", " [ 1.0 ,0.5] "])
def test_a_pose_may_mix_integers_and_doubles_and_be_a_text(value):
    pose = read_pose(value, JOINTS)
    assert pose is not None
    assert pose.positions == (1.0, 0.5)


def test_a_pose_that_is_not_set_is_None():
    assert read_pose([], JOINTS) is None


@pytest.mark.parametrize("value", ["", "home", "[up, down]", "1, 2", 5, 0.5, {"j0": 1}])
def test_refuses_a_value_that_is_not_a_list(value):
    with pytest.raises(ParameterValueError, match="must be a list of 2 numbers"):
        read_pose(value, JOINTS)


@pytest.mark.parametrize("value", [[1.0], "[1, 2, 3]", "[nan, 0]", ["a", "b"]])
def test_refuses_a_list_that_is_not_a_pose(value):
    with pytest.raises(PoseError):
        read_pose(value, JOINTS)


def test_joint_names_are_a_list_of_texts():
    assert read_joint_names(["a", "b"]) == ("a", "b")


@pytest.mark.parametrize("value", [[], "a", [1, 2], [""], None])
def test_refuses_a_value_that_is_not_a_list_of_names(value):
    with pytest.raises(ParameterValueError, match="must be a list of joint names"):
        read_joint_names(value)


def test_refuses_a_name_that_comes_twice():
    with pytest.raises(ParameterValueError, match="names a joint twice: a, b, a"):
        read_joint_names(["a", "b", "a"])


@pytest.mark.parametrize("value", [[0.2, -1], (0.2, -1.0), array("d", [0.2, -1.0]), "[0.2, -1]"])
def test_a_place_is_two_numbers(value):
    assert read_place(value) == (0.2, -1.0)


@pytest.mark.parametrize("value", [[1], [1, 2, 3], [1, True], [1, float("nan")], "here", 1.0, None])
def test_refuses_a_value_that_is_not_a_position(value):
    with pytest.raises(ParameterValueError, match="must be a list of two numbers, x and y"):
        read_place(value)
