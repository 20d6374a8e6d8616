"""Lines from a descriptor, and what a person may type."""

import os
import threading
from collections.abc import Iterator

import pytest

from arm_controller.pose import PoseError
from arm_controller.publisher_terminal_node import parse_line, read_lines

JOINTS = ("j0", "j1", "j2", "j3")


class Pipe:
    """A pipe to type into, and the lines at its other end."""

    def __init__(self) -> None:
        self._read_end, self._write_end = os.pipe()
        self._wake_read, self._wake_write = os.pipe()
        self.lines = read_lines(self._read_end, self._wake_read)

    def type(self, data: bytes) -> None:
        os.write(self._write_end, data)

    def end(self) -> None:
        os.write(self._wake_write, b"x")

    def close_input(self) -> None:
        if self._write_end >= 0:
            os.close(self._write_end)
            self._write_end = -1

    def close(self) -> None:
        self.close_input()
        for end in (self._read_end, self._wake_read, self._wake_write):
            os.close(end)


@pytest.fixture
def pipe() -> Iterator[Pipe]:
    made = Pipe()
    yield made
    made.close()


def test_reads_line_by_line_however_the_input_is_cut(pipe):
    pipe.type(b"one\ntwo\r\nthr")
    assert [next(pipe.lines), next(pipe.lines)] == ["one", "two"]
    pipe.type(b"ee\n")
    assert next(pipe.lines) == "three"


def test_a_last_line_without_a_line_break_is_used(pipe):
    pipe.type(b"one\n\nlast")
    pipe.close_input()
    assert list(pipe.lines) == ["one", "", "last"]


def test_the_end_of_input_is_the_end(pipe):
    pipe.close_input()
    assert list(pipe.lines) == []


def test_bytes_that_are_not_text_do_not_raise(pipe):
    pipe.type(b"\xff\xfe 1\n")
    assert next(pipe.lines) == "\ufffd\ufffd 1"


def test_a_blocked_reader_can_be_ended(pipe):
    results: list[list[str]] = []
    reader = threading.Thread(target=lambda: results.append(list(pipe.lines)))
    reader.start()
    pipe.end()
    reader.join(timeout=10.0)
    assert not reader.is_alive()
    assert results == [[]]


def test_nothing_more_is_read_after_the_end(pipe):
    pipe.type(b"one\ntwo\n")
    assert next(pipe.lines) == "one"
    pipe.end()
    assert list(pipe.lines) == []


def test_a_descriptor_that_cannot_be_read_is_the_end_of_input(pipe, tmp_path):
    descriptor = os.open(tmp_path, os.O_RDONLY)
    assert list(read_lines(descriptor, pipe._wake_read)) == []
    os.close(descriptor)


@pytest.mark.parametrize("line", ["0.1 -2 .3 1e-1", "  0.1\t-2   0.3 0.1  "])
def test_takes_numbers_separated_by_any_blanks(line):
    assert parse_line(line, JOINTS) == (0.1, -2.0, 0.3, 0.1)


@pytest.mark.parametrize(
    ("line", "answer"),
    [
        ("", r"^Please enter exactly 4 numbers\. \(There were 0\.\)"),
        ("1 2 3 4 5", r"^Please enter exactly 4 numbers\. \(There were 5\.\)"),
        ("1 two 3 4", r"exactly 4 numbers\. \('two' is not a number\.\)"),
        ("1 nan 3 4", "joint 'j1'"),
    ],
)
def test_says_what_is_wrong_with_a_line(line, answer):
    with pytest.raises(PoseError, match=answer):
        parse_line(line, JOINTS)
