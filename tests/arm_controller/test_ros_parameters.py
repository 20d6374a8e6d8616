"""Parameters whose exact type does not matter."""

from array import array

import pytest

from arm_controller.arm_controller_node import read_rate
from arm_controller.pick_and_place_node import read_place
from arm_controller.ros_parameters import read_joint_names, read_positive, read_zero_or_more
from arm_node.parameter_values import ParameterValueError


@pytest.mark.parametrize(
    ("read", "value", "number"),
    [
        (read_positive, 2, 2.0),
        (read_positive, 1e9, 1e9),
        (read_zero_or_more, 0, 0.0),
        *((read_rate, rate, rate) for rate in (0, 1e-9, 20)),
    ],
)
def test_a_number_may_be_an_integer(read, value, number):
    assert read(value) == number


@pytest.mark.parametrize(
    ("read", "value", "wanted"),
    [
        *(
            (read_positive, value, r"must be a number above 0, at most 1e\+09, not")
            for value in (0, -1.5, float("nan"), float("inf"), "2", True, None, [2.0], 1.1e9, 2**62)
        ),
        (read_zero_or_more, -1, r"must be a number from 0 to 1e\+09, not -1"),
        # A timer cannot count their periods.
        *((read_rate, rate, "must be 0 or at least 1e-09, not") for rate in (1e-10, 5e-324)),
        *(
            (read_joint_names, value, "must be a list of joint names")
            for value in ([], "a", [1, 2], [""], None)
        ),
        (read_joint_names, ["a", "b", "a"], "names a joint twice: a, b, a"),
        *(
            (read_place, value, "must be a list of two numbers, x and y")
            for value in ([1], [1, 2, 3], [1, True], [1, float("nan")], "here", 1.0, None)
        ),
    ],
)
def test_refuses_other_values_and_says_what_it_wants(read, value, wanted):
    with pytest.raises(ParameterValueError, match=wanted):
        read(value)


def test_joint_names_are_a_list_of_texts():
    assert read_joint_names(["a", "b"]) == ("a", "b")


@pytest.mark.parametrize("value", [[0.2, -1], (0.2, -1.0), array("d", [0.2, -1.0]), "[0.2, -1]"])
def test_a_place_is_two_numbers(value):
    assert read_place(value) == (0.2, -1.0)
