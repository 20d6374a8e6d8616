"""Simulation time compared with wall time."""

import numpy as np
import pytest

from arm_viewer.ros.clock_observer import ClockComparison


def compare(readings):
    comparison = ClockComparison()
    for wall_s, time_s in readings:
        comparison.add(wall_s, time_s)
    return comparison.result()


def test_nothing_is_known_before_the_first_reading():
    assert ClockComparison().result() is None


def test_the_first_reading_has_no_factor_yet():
    result = compare([(100.0, 5.0)])
    assert (result.time_s, result.factor, result.lag_s) == (5.0, 0.0, 0.0)


@pytest.mark.parametrize("factor", [1.0, 0.5, 3.0])
def test_factor_and_lag(factor):
    result = compare((100.0 + t, 5.0 + factor * t) for t in np.arange(0.0, 4.01, 0.125))
    assert result.time_s == pytest.approx(5.0 + factor * 4.0)
    assert result.factor == pytest.approx(factor)
    assert result.lag_s == pytest.approx(max(0.0, 4.0 * (1.0 - factor)))


def test_a_stall_shows_in_the_factor_soon_and_in_the_lag_for_long():
    runs = [(t, t) for t in np.arange(0.0, 5.0, 0.5)]
    stands = [(t, 5.0) for t in np.arange(5.0, 8.01, 0.5)]
    result = compare([*runs, *stands])
    assert result.factor == 0.0
    assert result.lag_s == pytest.approx(3.0)


def test_the_lag_of_long_ago_is_forgotten():
    stood = [(t, 0.0) for t in np.arange(0.0, 5.0, 0.5)]
    runs = [(t, t - 5.0) for t in np.arange(5.0, 30.0, 0.5)]
    result = compare([*stood, *runs])
    assert result.lag_s == pytest.approx(0.0)


def test_a_reset_restarts_the_comparison():
    result = compare([(0.0, 50.0), (1.0, 51.0), (2.0, 0.0), (3.0, 1.0)])
    assert result.factor == pytest.approx(1.0)
    assert result.lag_s == pytest.approx(0.0)


def test_time_is_expected_to_go_on_as_before():
    result = compare([(0.0, 50.0), (1.0, 50.5), (2.0, 51.0)])
    assert result.at(2.2) == pytest.approx(51.1)


def test_what_was_cleared_is_not_known():
    comparison = ClockComparison()
    comparison.add(0.0, 1.0)
    comparison.clear()
    assert comparison.result() is None
