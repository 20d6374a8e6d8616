"""In which cycles something with its own rate is due."""

import pytest

from arm_control.loop.schedule import Schedule


def due(rate_hz: float, times_s: list[float]) -> list[float]:
    schedule = Schedule(rate_hz)
    return [time_s for time_s in times_s if schedule.is_due(time_s)]


def cycles(count: int, rate_hz: float = 100.0, start_s: float = 0.0) -> list[float]:
    return [start_s + i / rate_hz for i in range(count)]


@pytest.mark.parametrize(("rate_hz", "count"), [(50.0, 500), (30.0, 300), (100.0, 1000)])
def test_the_rate_is_kept_over_a_long_time(rate_hz, count):
    assert len(due(rate_hz, cycles(1000, start_s=12345.67))) == count


def test_no_rate_is_higher_than_that_of_the_cycles():
    assert due(1000.0, cycles(20)) == cycles(20)


def test_a_pause_is_not_made_up_for():
    after = cycles(10, start_s=5.0)
    assert due(50.0, [*cycles(3), *after]) == [0.0, 0.02, *after[::2]]


def test_setting_the_clock_back_does_not_stop_it():
    assert due(50.0, [100.0, 0.0, 0.01, 0.02]) == [100.0, 0.0, 0.02]


def test_events_keep_their_times_after_a_pause():
    assert due(50.0, [0.0, 1.005, 1.015, 1.025]) == [0.0, 1.005, 1.025]


def test_a_fixed_start_numbers_the_events_by_their_times():
    schedule = Schedule(10.0, 0.0)
    times_s = [0.25, 0.3, 0.35, 0.71]
    assert [schedule.number for time_s in times_s if schedule.is_due(time_s)] == [2, 3, 7]
    assert not schedule.is_due(0.79)
    assert schedule.is_due(0.8)


def test_nothing_becomes_due_while_time_stands_still():
    assert due(30.0, [5.0, 5.0, 5.0]) == [5.0]


def test_a_schedule_that_restarts_has_its_first_event_in_the_next_cycle():
    schedule = Schedule(1.0)
    assert schedule.is_due(3.0)
    schedule.restart()
    assert schedule.is_due(3.1)
    assert not schedule.is_due(3.2)
    assert schedule.is_due(4.1)
