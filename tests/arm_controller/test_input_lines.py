"""Lines from a descriptor, with an end that another thread may call."""

import os
import threading
from collections.abc import Iterator

import pytest

from arm_controller.input_lines import InputLines


class Pipe:
    """A pipe to type into, and the lines at its other end."""

    def __init__(self) -> None:
        self.read_end, self._write_end = os.pipe()
        self.lines = InputLines(self.read_end)

    def type(self, data: bytes) -> None:
        os.write(self._write_end, data)

    def close_input(self) -> None:
        if self._write_end >= 0:
            os.close(self._write_end)
            self._write_end = -1


@pytest.fixture
def pipe() -> Iterator[Pipe]:
    made = Pipe()
    with made.lines:
        yield made
    made.close_input()
    os.close(made.read_end)


def test_reads_line_by_line_however_the_input_is_cut(pipe):
    pipe.type(b"one\ntwo\r\nthr")
    assert pipe.lines.read_line() == "one"
    assert pipe.lines.read_line() == "two"
    pipe.type(b"ee\n")
    assert pipe.lines.read_line() == "three"


def test_a_last_line_without_an_end_counts(pipe):
    pipe.type(b"one\n\nlast")
    pipe.close_input()
    assert [pipe.lines.read_line() for _ in range(4)] == ["one", "", "last", None]


def test_the_end_of_input_stays_the_end(pipe):
    pipe.close_input()
    assert pipe.lines.read_line() is None
    assert pipe.lines.read_line() is None


def test_bytes_that_are_no_text_do_not_raise(pipe):
    pipe.type(b"\xff\xfe 1\n")
    assert pipe.lines.read_line() == "\ufffd\ufffd 1"


def test_a_blocked_reader_can_be_ended(pipe):
    results: list[str | None] = []
    reader = threading.Thread(target=lambda: results.append(pipe.lines.read_line()))
    reader.start()
    pipe.lines.end()
    reader.join(timeout=10.0)
    assert not reader.is_alive()
    assert results == [None]


def test_nothing_more_is_read_after_the_end(pipe):
    pipe.type(b"one\ntwo\n")
    assert pipe.lines.read_line() == "one"
    pipe.lines.end()
    assert pipe.lines.read_line() is None


def test_a_descriptor_that_cannot_be_read_is_the_end_of_input(tmp_path):
    descriptor = os.open(tmp_path, os.O_RDONLY)
    with InputLines(descriptor) as lines:
        assert lines.read_line() is None
    os.close(descriptor)
