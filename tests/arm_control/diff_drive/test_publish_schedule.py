"""In which cycles something is published."""

import pytest

from arm_control.diff_drive.publish_schedule import PublishSchedule


def published(rate_hz: float, times_s: list[float]) -> list[float]:
    schedule = PublishSchedule(rate_hz)
    return [time_s for time_s in times_s if schedule.is_due(time_s)]


def cycles(count: int, rate_hz: float = 100.0, start_s: float = 0.0) -> list[float]:
    return [start_s + i / rate_hz for i in range(count)]


@pytest.mark.parametrize(("rate_hz", "count"), [(50.0, 500), (30.0, 300), (100.0, 1000)])
def test_the_rate_is_kept_over_a_long_time(rate_hz, count):
    assert len(published(rate_hz, cycles(1000, start_s=12345.67))) == count


def test_no_rate_is_higher_than_that_of_the_cycles():
    assert published(1000.0, cycles(20)) == cycles(20)


def test_a_pause_is_not_made_up_for():
    after = cycles(10, start_s=5.0)
    assert published(50.0, [*cycles(3), *after]) == [0.0, 0.02, *after[::2]]


def test_a_clock_that_is_set_back_does_not_silence_it():
    assert published(50.0, [100.0, 0.0, 0.01, 0.02]) == [100.0, 0.0, 0.02]
