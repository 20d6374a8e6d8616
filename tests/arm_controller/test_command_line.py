"""What a person may type."""

import pytest

from arm_controller.command_line import parse_pose_line, prompt
from arm_controller.errors import CommandLineError, PoseError

JOINTS = ("j0", "j1", "j2", "j3")


def test_the_prompt_says_how_many_numbers():
    assert prompt(JOINTS) == "Enter the 4 Joint Variables to send (separated by spaces): "


@pytest.mark.parametrize("line", ["0.1 -2 .3 1e-1", "  0.1\t-2   0.3 0.1  "])
def test_takes_numbers_separated_by_any_blanks(line):
    assert parse_pose_line(line, JOINTS).positions == (0.1, -2.0, 0.3, 0.1)


@pytest.mark.parametrize("line", ["", "1 2 3", "1 2 3 4 5"])
def test_wants_as_many_numbers_as_joints(line):
    with pytest.raises(CommandLineError, match=r"^Please enter exactly 4 numbers\."):
        parse_pose_line(line, JOINTS)


def test_says_which_word_is_no_number():
    with pytest.raises(CommandLineError, match=r"exactly 4 numbers\. \('two' is not a number\.\)"):
        parse_pose_line("1 two 3 4", JOINTS)


def test_refuses_nan():
    with pytest.raises(PoseError, match="joint 'j1'"):
        parse_pose_line("1 nan 3 4", JOINTS)
