"""What /clock says about pace and lag, before, in and after a pause."""

import time
from collections.abc import Iterator
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from builtin_interfaces.msg import Time
from rclpy.serialization import serialize_message
from rosgraph_msgs.msg import Clock

from arm_viewer.ros.clock_observer import ClockComparison, ClockObserver


class Arrivals:
    """Stands for the subscriptions; holds what has arrived since the last look."""

    def __init__(self) -> None:
        self.stamps: list[float] = []

    def subscribe(self, *_: object) -> None: ...

    def take(self, *_: object) -> Iterator[tuple[bytes, dict[str, int]]]:
        for stamp in self.stamps:
            clock = Clock(clock=Time(sec=int(stamp), nanosec=round(stamp % 1 * 1e9)))
            yield serialize_message(clock), {"received_timestamp": time.time_ns()}
        self.stamps = []


@pytest.fixture
def observe():
    """Return a function that lets the clock show a time at a wall time, and returns the result."""
    arrivals = Arrivals()
    polled: Any = arrivals
    node: Any = SimpleNamespace(count_publishers=lambda _topic: 1)
    observer = ClockObserver(node, polled)

    def at(wall_s: float, *stamps: float) -> Any:
        arrivals.stamps = list(stamps)
        observer.collect(wall_s)
        return observer.time

    return at


def test_a_pause_is_not_lag(observe):
    for tick in range(20):
        running = observe(100.0 + tick / 4, tick / 4)
    assert running.factor == pytest.approx(1.0, abs=0.02)
    for tick in range(1, 20):
        paused = observe(104.75 + tick / 4)
    assert paused.factor == 0.0
    assert paused.lag_s == pytest.approx(0.0, abs=0.02)
    for tick in range(1, 9):
        resumed = observe(110.0 + tick / 4, 4.75 + tick / 4)
    assert resumed.factor == pytest.approx(1.0, abs=0.02)
    assert resumed.lag_s == pytest.approx(0.0, abs=0.02)


def test_a_clock_that_is_faster_has_no_lag(observe):
    for tick in range(9):
        fast = observe(100.0 + tick / 4, 2.0 * tick)
    assert fast.factor == pytest.approx(8.0, abs=0.1)
    assert fast.lag_s == 0.0


def test_a_slow_clock_lags(observe):
    for tick in range(9):
        slow = observe(100.0 + tick / 4, tick / 8)
    assert slow.lag_s == pytest.approx(1.0, abs=0.02)


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
