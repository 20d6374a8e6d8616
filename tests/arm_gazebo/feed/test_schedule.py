"""When frames are due: no drift at any tick rate."""

import math

from hypothesis import given
from hypothesis import strategies as st

from arm_control.loop.schedule import TOLERANCE_S
from arm_gazebo.feed.schedule import FrameDue, FrameSchedule

rates = st.one_of(st.sampled_from([5.0, 24.0, 29.97, 30.0, 60.0]), st.floats(0.5, 200.0))
ticks = st.sampled_from([1 / 30, 1 / 100, 1 / 225, 1 / 500, 1 / 1000, 0.0123])


def taken_at(schedule: FrameSchedule, times_s: list[float]) -> list[tuple[float, FrameDue]]:
    taken = []
    for time_s in times_s:
        if not schedule.nothing_due(time_s):
            taken += [(time_s, frame) for frame in schedule.take_due(time_s)]
    return taken


def summed(tick_s: float, count: int) -> list[float]:
    """Times as a simulation makes them: by adding, with its rounding errors."""
    times_s, time_s = [], 0.0
    for _ in range(count):
        times_s.append(time_s)
        time_s += tick_s
    return times_s


@given(rate_hz=rates, tick_s=ticks, count=st.integers(1, 2000))
def test_a_frame_is_taken_at_the_first_tick_at_or_after_its_time(rate_hz, tick_s, count):
    times_s = summed(tick_s, count)
    taken = {time_s: frame.number for time_s, frame in taken_at(FrameSchedule([rate_hz]), times_s)}
    expected, last = {}, -1
    for time_s in times_s:
        newest = math.floor((time_s + TOLERANCE_S) * rate_hz)
        if newest > last:
            expected[time_s] = last = newest
    assert taken == expected


@given(tick_s=ticks, share=st.floats(0.01, 1.0))
def test_no_frame_is_skipped_if_ticks_are_fast_enough(tick_s, share):
    times_s = summed(tick_s, 3000)
    taken = taken_at(FrameSchedule([share / tick_s]), times_s)
    assert [frame.number for _, frame in taken] == list(range(len(taken)))
    assert all(
        -TOLERANCE_S <= time_s - frame.number * tick_s / share < tick_s for time_s, frame in taken
    )


def test_30_hz_at_100_hz_ticks():
    taken = taken_at(FrameSchedule([30.0]), summed(0.01, 11))
    assert [round(time_s, 3) for time_s, _ in taken] == [0.0, 0.04, 0.07, 0.1]


def test_serials_have_no_gaps_if_a_tick_passes_several_frames():
    taken = [frame for _, frame in taken_at(FrameSchedule([30.0]), [0.0, 0.1, 0.2])]
    assert [frame.number for frame in taken] == [0, 3, 6]
    assert [frame.serial for frame in taken] == [0, 1, 2]


def test_cameras_of_different_rates_are_due_by_themselves():
    taken = taken_at(FrameSchedule([10.0, 5.0]), summed(0.05, 5))
    assert [(round(t, 2), frame.camera) for t, frame in taken] == [
        (0.0, 0),
        (0.0, 1),
        (0.1, 0),
        (0.2, 0),
        (0.2, 1),
    ]


def test_a_frame_is_due_once_while_time_is_paused():
    schedule = FrameSchedule([30.0])
    assert len(taken_at(schedule, [0.0, 0.0, 0.0])) == 1


def test_time_that_jumps_back_restarts_the_frames():
    schedule = FrameSchedule([10.0])
    taken_at(schedule, summed(0.05, 100))
    assert not schedule.nothing_due(0.0)
    (frame,) = schedule.take_due(0.0)
    assert frame.number == 0
    assert frame.serial == 50
    assert schedule.nothing_due(0.05)


def test_a_late_start_takes_the_frame_of_its_time():
    (frame,) = FrameSchedule([30.0]).take_due(100.0)
    assert frame.number == 3000


def test_without_cameras_nothing_is_due():
    schedule = FrameSchedule([])
    assert schedule.nothing_due(0.0)
    assert schedule.nothing_due(1e9)
