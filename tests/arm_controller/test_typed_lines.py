"""What a person may type, and where the input ends."""

import io
import sys

import pytest

from arm_controller.pose import PoseError
from arm_controller.publisher_terminal_node import parse_line, typed_lines

JOINTS = ("j0", "j1", "j2", "j3")


def test_a_last_line_without_a_line_break_is_used(monkeypatch):
    monkeypatch.setattr(sys, "stdin", io.StringIO("one\n\nlast"))
    assert [line.strip() for line in typed_lines("")] == ["one", "", "last"]


def test_a_program_without_input_has_no_lines(monkeypatch):
    monkeypatch.setattr(sys, "stdin", None)
    assert list(typed_lines("")) == []


def test_a_terminal_that_is_gone_is_the_end_of_input(monkeypatch):
    class Gone(io.StringIO):
        def __next__(self) -> str:
            raise OSError(5, "Input/output error")

    monkeypatch.setattr(sys, "stdin", Gone())
    assert list(typed_lines("")) == []


@pytest.mark.parametrize("line", ["0.1 -2 .3 1e-1", "  0.1\t-2   0.3 0.1  "])
def test_takes_numbers_separated_by_any_blanks(line):
    assert parse_line(line, JOINTS) == (0.1, -2.0, 0.3, 0.1)


@pytest.mark.parametrize(
    ("line", "answer"),
    [
        ("", r"^Please enter exactly 4 numbers\. \(There were 0\.\)"),
        ("1 2 3 4 5", r"^Please enter exactly 4 numbers\. \(There were 5\.\)"),
        ("1 two 3 4", "exactly 4 numbers.*'two'"),
        ("1 nan 3 4", "joint 'j1'"),
    ],
)
def test_says_what_is_wrong_with_a_line(line, answer):
    with pytest.raises(PoseError, match=answer):
        parse_line(line, JOINTS)
