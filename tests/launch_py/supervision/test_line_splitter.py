"""Bytes to lines."""

from launch_py.supervision.child_process import MAX_LINE_BYTES, LineSplitter


def lines(*chunks):
    splitter = LineSplitter()
    found = [line for chunk in chunks for line in splitter.feed(chunk)]
    return found + list(splitter.finish())


def test_lines_may_come_in_pieces():
    assert lines(b"a\nb", b"c\n", b"d") == ["a", "bc", "d"]


def test_a_character_may_come_in_pieces():
    assert lines(b"\xc3", b"\xa4\n") == ["ä"]


def test_invalid_utf_8_is_replaced():
    assert lines(b"a\xffb\n") == ["a\ufffdb"]


def test_carriage_returns_overwrite_as_in_a_terminal():
    assert lines(b"10 %\r20 %\rdone\r\n") == ["done"]


def test_an_endless_line_is_cut():
    found = lines(b"x" * (MAX_LINE_BYTES * 2 + 1))
    assert [len(line) for line in found] == [MAX_LINE_BYTES, MAX_LINE_BYTES, 1]
