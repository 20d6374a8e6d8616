"""What /clock says about pace and lag, before, in and after a pause."""

import time
from collections.abc import Iterator
from types import SimpleNamespace
from typing import Any

import pytest
from builtin_interfaces.msg import Time
from rclpy.serialization import serialize_message
from rosgraph_msgs.msg import Clock

from arm_viewer.ros.clock_observer import ClockObserver


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
