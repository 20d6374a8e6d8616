"""Rates, bandwidths and delays, in the format of ros2."""

import pytest

from arm_cli.errors import StoppedError
from arm_cli.topic.measuring import BandwidthWindow, DelayWindow, RateWindow, report_every_second

MS = 1_000_000


def rate_of(*times_ms, size=100):
    window = RateWindow(size)
    for time_ms in times_ms:
        window.add(time_ms * MS)
    return window.describe()


def test_rate():
    assert rate_of(0, 10, 30) == (
        "average rate: 66.667\n\tmin: 0.010s max: 0.020s std dev: 0.00500s window: 2"
    )


def test_no_rate_before_the_second_message():
    assert rate_of(5) is None


def test_the_rate_looks_back_over_its_window_only():
    assert str(rate_of(0, 1000, 1010, 1020, size=2)).startswith("average rate: 100.000\n")


def test_a_clock_that_jumps_back_resets_the_window():
    assert rate_of(0, 10, 5) is None
    assert str(rate_of(0, 10, 5, 25)).startswith("average rate: 50.000\n")


def test_bandwidth_in_suitable_units():
    window = BandwidthWindow(10)
    assert window.describe(0.0) is None
    window.add(0.0, 100)
    window.add(1.0, 300)
    assert window.describe(2.0) == (
        "200 B/s from 2 messages\n\tMessage size mean: 200 B min: 100 B max: 300 B"
    )
    window.add(1.0, 3_600)
    assert str(window.describe(2.0)).startswith("2.00 KB/s from 3 messages\n")
    window.add(1.0, 4_000_000)
    assert str(window.describe(2.0)).startswith("2.00 MB/s from 4 messages\n")


def test_delay():
    window = DelayWindow(2)
    assert window.describe() is None
    for delay_ms in (500, 10, 20):
        window.add(delay_ms * MS)
    assert window.describe() == (
        "average delay: 0.015\n\tmin: 0.010s max: 0.020s std dev: 0.00500s window: 2"
    )


class Seconds:
    """A fake session: one action happens each second, and then a signal arrives."""

    def __init__(self, *actions):
        self._actions = iter(actions)

    def wait_until(self, condition, _silence):
        while not condition():
            self.spin_for(1.0)

    def spin_for(self, _duration_s):
        action = next(self._actions, None)
        if action is None:
            raise StoppedError
        action()


@pytest.mark.parametrize("window", [RateWindow(10), DelayWindow(10)])
def test_nothing_is_reported_while_no_message_arrives(capsys, window):
    def message():
        window.add((window.taken + 1) * MS)

    def silence():
        pass

    session = Seconds(message, message, silence, silence, message, silence)
    with pytest.raises(StoppedError):
        report_every_second(session, window.describe, str, lambda: window.taken)
    reports = capsys.readouterr().out.splitlines()[1::2]
    counts = [line.rpartition("window: ")[2] for line in reports]
    assert counts == (["1", "2"] if isinstance(window, RateWindow) else ["2", "3"])
