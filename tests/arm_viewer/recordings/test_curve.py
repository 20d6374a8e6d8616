"""The curve of a number over a recording."""

import struct

import numpy as np
import pytest

from arm_viewer.recordings.curve import COLUMNS, NumberPlace, read_curve

PATTERN = np.frombuffer(b"name" + bytes(8), dtype=np.uint8)
PLACE = NumberPlace(4, PATTERN, np.array([True] * 4 + [False] * 8))


def message(number, name=b"name"):
    return name + struct.pack("<d", number)


@pytest.fixture
def curve_of(opened):
    return lambda file, *goes_on: read_curve(opened(file), "/a", PLACE, *goes_on)


def test_no_peak_is_lost(write_mcap, curve_of):
    count = 20 * COLUMNS
    numbers = np.zeros(count)
    numbers[7777], numbers[12345] = 5.0, -3.0
    rows = [("/a", 1000 * n, message(value)) for n, value in enumerate(numbers)]
    curve = curve_of(write_mcap(rows[: count // 2], rows[count // 2 :]))
    assert (curve.high.max(), curve.low.min(), curve.skipped) == (5.0, -3.0, 0)
    assert np.argmax(curve.high) == 7777 * COLUMNS // (count - 1)
    assert np.argmin(curve.low) == 12345 * COLUMNS // (count - 1)


def test_a_gap_is_a_gap_and_numbers_that_are_none_are_left_out(write_mcap, curve_of):
    rows = [("/a", 0, message(1.0)), ("/a", 500, message(np.nan)), ("/a", 1000, message(np.inf))]
    curve = curve_of(write_mcap([*rows, ("/a", 2000, message(2.0))]))
    assert np.flatnonzero(np.isfinite(curve.low)).tolist() == [0, COLUMNS - 1]


def test_messages_of_another_layout_are_counted_and_left_out(write_mcap, curve_of):
    rows = [("/a", 0, message(1.0)), ("/a", 10, message(9.0, b"eman")), ("/a", 20, b"short")]
    curve = curve_of(write_mcap(rows))
    assert curve.skipped == 2
    assert np.nanmax(curve.high) == 1.0


def test_it_ends_when_nobody_wants_it_any_more(write_mcap, curve_of):
    file = write_mcap([("/a", 0, message(1.0))], [("/a", 10, message(2.0))])
    answers = iter([True, False])
    curve = curve_of(file, lambda: next(answers))
    assert np.nanmax(curve.high) == pytest.approx(1.0)
