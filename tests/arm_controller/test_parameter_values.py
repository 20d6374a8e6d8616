"""Parameters whose type the user need not get right."""

from array import array
from pathlib import Path

import pytest

from arm_controller.errors import ParameterValueError, PoseError
from arm_controller.parameter_values import (
    read_flag,
    read_joint_names,
    read_number,
    read_path,
    read_place,
    read_pose,
    read_prefix,
    read_rate,
    read_topic,
)

JOINTS = ("j0", "j1")


@pytest.mark.parametrize("value", [2, 2.0])
def test_a_number_may_be_an_integer(value):
    assert read_number(value) == 2.0


@pytest.mark.parametrize("value", [0, -1.5, float("nan"), float("inf"), "2", True, None, [2.0]])
def test_refuses_what_is_no_positive_number(value):
    with pytest.raises(ParameterValueError, match="must be a number above 0, not"):
        read_number(value)


def test_zero_may_be_allowed():
    assert read_number(0, positive=False) == 0.0
    with pytest.raises(ParameterValueError, match="must be 0 or a number above, not -1"):
        read_number(-1, positive=False)


@pytest.mark.parametrize("value", [1.1e9, 2**62])
def test_a_number_that_no_timer_can_count_is_refused(value: float):
    assert read_number(1e9) == 1e9
    with pytest.raises(ParameterValueError, match=r"must be at most 1e\+09, not"):
        read_number(value)


@pytest.mark.parametrize("value", [0, 1e-9, 20])
def test_a_rate_may_be_zero_and_slow(value: float):
    assert read_rate(value) == value


@pytest.mark.parametrize("value", [1e-10, 5e-324])
def test_a_rate_whose_period_no_timer_can_count_is_refused(value: float):
    with pytest.raises(ParameterValueError, match="must be 0 or at least 1e-09, not"):
        read_rate(value)


@pytest.mark.parametrize("value", [[1, 0.5], array("d", [1, 0.5]), "[1, 0.5]", " [ 1.0 ,0.5] "])
def test_a_pose_may_mix_integers_and_doubles_and_be_a_text(value):
    pose = read_pose(value, JOINTS)
    assert pose is not None
    assert pose.positions == (1.0, 0.5)


def test_a_pose_that_is_not_set_is_none():
    assert read_pose(None, JOINTS) is None


@pytest.mark.parametrize("value", ["", "home", "[up, down]", "1, 2", 5, 0.5, {"j0": 1}])
def test_refuses_what_is_no_list(value):
    with pytest.raises(ParameterValueError, match="must be a list of 2 numbers"):
        read_pose(value, JOINTS)


@pytest.mark.parametrize("value", [[], [1.0], "[1, 2, 3]", "[nan, 0]", ["a", "b"]])
def test_refuses_a_list_that_is_no_pose(value):
    with pytest.raises(PoseError):
        read_pose(value, JOINTS)


def test_joint_names_are_a_list_of_texts():
    assert read_joint_names(["a", "b"]) == ("a", "b")


@pytest.mark.parametrize("value", [[], "a", [1, 2], [""], None])
def test_refuses_what_is_no_list_of_names(value):
    with pytest.raises(ParameterValueError, match="must be a list of joint names"):
        read_joint_names(value)


def test_refuses_a_name_that_comes_twice():
    with pytest.raises(ParameterValueError, match="names a joint twice: a, b, a"):
        read_joint_names(["a", "b", "a"])


def test_a_path_may_start_at_home(monkeypatch):
    monkeypatch.setenv("HOME", "/home/somebody")
    assert read_path("~/poses.yaml") == Path("/home/somebody/poses.yaml")


@pytest.mark.parametrize("value", ["", 3, None])
def test_refuses_what_is_no_path(value):
    with pytest.raises(ParameterValueError, match="must be the path of a file"):
        read_path(value)


@pytest.mark.parametrize("value", [True, False])
def test_a_flag_is_true_or_false(value):
    assert read_flag(value) is value


@pytest.mark.parametrize("value", [0, 1, "true", None])
def test_refuses_what_is_no_flag(value):
    with pytest.raises(ParameterValueError, match="must be true or false, not"):
        read_flag(value)


def test_a_topic_is_a_text():
    assert read_topic("{joint}p_controller/command") == "{joint}p_controller/command"


@pytest.mark.parametrize("value", ["", 3, None, ["a"]])
def test_refuses_what_is_no_topic(value):
    with pytest.raises(ParameterValueError, match="must be the name of a topic, not"):
        read_topic(value)


@pytest.mark.parametrize("value", [[0.2, -1], (0.2, -1.0), array("d", [0.2, -1.0]), "[0.2, -1]"])
def test_a_place_is_two_numbers(value):
    assert read_place(value) == (0.2, -1.0)


@pytest.mark.parametrize("value", [[1], [1, 2, 3], [1, True], [1, float("nan")], "here", 1.0, None])
def test_refuses_what_is_no_place(value):
    with pytest.raises(ParameterValueError, match="must be a list of two numbers, x and y"):
        read_place(value)


def test_a_prefix_is_a_text_that_may_be_empty():
    assert (read_prefix(""), read_prefix("left_")) == ("", "left_")
    with pytest.raises(ParameterValueError, match="must be a text, not 5"):
        read_prefix(5)
