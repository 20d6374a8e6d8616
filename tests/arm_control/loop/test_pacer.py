"""Deadlines, catching up, throttling, and figures, on a clock that moves by hand."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from arm_control.loop.clock import Throttle
from arm_control.loop.pacer import CATCH_UP_S, WARNING_INTERVAL_S, Pacer
from arm_control.testing import ManualClock


def run_tick(pacer: Pacer, clock: ManualClock, work_s: float = 0.0) -> None:
    """Wait as a loop would, then tick."""
    clock.advance(max(0.0, pacer.remaining_s()))
    pacer.begin()
    clock.advance(work_s)
    pacer.end()


def test_the_first_tick_is_due_at_once():
    assert Pacer(0.01, clock=ManualClock(5.0)).remaining_s() == 0.0


def test_the_next_tick_is_due_one_period_later():
    clock = ManualClock()
    pacer = Pacer(0.01, clock=clock)
    pacer.begin()
    clock.advance(0.004)
    pacer.end()
    assert pacer.remaining_s() == pytest.approx(0.006)


@pytest.mark.parametrize(("factor", "wall_s"), [(1.0, 0.01), (2.0, 0.005), (0.25, 0.04)])
def test_the_real_time_factor_scales_the_wall_period(factor, wall_s):
    clock = ManualClock()
    pacer = Pacer(0.01, real_time_factor=factor, clock=clock)
    pacer.begin()
    assert pacer.remaining_s() == pytest.approx(wall_s)


def test_factor_zero_never_waits():
    clock = ManualClock()
    pacer = Pacer(0.01, real_time_factor=0.0, clock=clock)
    for _ in range(100):
        assert pacer.remaining_s() == 0.0
        run_tick(pacer, clock, 0.001)
    assert clock.now_s() == pytest.approx(0.1)


@given(
    work_s=st.lists(st.floats(0.0, 0.009), min_size=10, max_size=300),
    factor=st.sampled_from([0.5, 1.0, 3.0]),
)
def test_deadlines_do_not_drift(work_s, factor):
    clock = ManualClock()
    pacer = Pacer(0.03, real_time_factor=factor, clock=clock)
    for work in work_s:
        run_tick(pacer, clock, work / factor)
    clock.advance(pacer.remaining_s())
    assert clock.now_s() == pytest.approx(len(work_s) * 0.03 / factor, abs=1e-9)


def test_a_short_stall_is_made_up_for():
    clock = ManualClock()
    pacer = Pacer(0.01, clock=clock)
    run_tick(pacer, clock, work_s=0.035)
    for _ in range(10):
        run_tick(pacer, clock)
    assert clock.now_s() == pytest.approx(0.1)
    assert pacer.statistics.lost_s == 0.0


def test_of_a_long_stall_only_the_cap_is_made_up_for():
    clock = ManualClock()
    pacer = Pacer(0.01, clock=clock)
    run_tick(pacer, clock, work_s=1.01)
    at_once = 0
    while pacer.remaining_s() <= 1e-9:
        run_tick(pacer, clock)
        at_once += 1
    assert at_once == round(CATCH_UP_S / 0.01) + 1
    assert pacer.statistics.lost_s == pytest.approx(1.0 - CATCH_UP_S)


@given(stalls_s=st.lists(st.floats(0.0, 0.3), max_size=50), factor=st.sampled_from([0.5, 1.0, 4.0]))
def test_ticks_never_run_ahead_of_the_clock(stalls_s, factor):
    clock = ManualClock()
    pacer = Pacer(0.01, real_time_factor=factor, clock=clock)
    for ticks, stall_s in enumerate(stalls_s):
        run_tick(pacer, clock, stall_s)
        assert ticks * 0.01 <= clock.now_s() * factor + 1e-9


def test_lag_is_how_late_a_tick_starts():
    clock = ManualClock()
    pacer = Pacer(0.01, clock=clock)
    run_tick(pacer, clock, work_s=0.025)
    run_tick(pacer, clock)
    assert pacer.statistics.lag_s == pytest.approx(0.015)
    for _ in range(5):
        run_tick(pacer, clock)
    assert pacer.statistics.lag_s == pytest.approx(0.0)
    assert pacer.statistics.max_lag_s == pytest.approx(0.015)


def test_ticks_that_outlast_their_period_are_overruns():
    clock = ManualClock()
    pacer = Pacer(0.01, clock=clock)
    for work_s in (0.002, 0.012, 0.002, 0.002):
        run_tick(pacer, clock, work_s)
    assert (pacer.statistics.ticks, pacer.statistics.overruns) == (4, 1)


def test_the_achieved_factor_covers_the_last_second():
    clock = ManualClock()
    pacer = Pacer(0.01, real_time_factor=0.0, clock=clock)
    assert pacer.statistics.achieved_factor == 0.0
    while pacer.statistics.achieved_factor == 0.0:
        run_tick(pacer, clock, 0.002)
    assert pacer.statistics.achieved_factor == pytest.approx(5.0)


def test_restart_forgets_a_pause():
    clock = ManualClock()
    pacer = Pacer(0.01, clock=clock)
    run_tick(pacer, clock)
    clock.advance(100.0)
    pacer.restart()
    run_tick(pacer, clock)
    assert pacer.remaining_s() == pytest.approx(0.01)
    assert (pacer.statistics.lag_s, pacer.statistics.lost_s) == (0.0, 0.0)


def test_the_factor_can_change_at_any_time():
    clock = ManualClock()
    pacer = Pacer(0.01, clock=clock)
    run_tick(pacer, clock)
    pacer.real_time_factor = 0.1
    run_tick(pacer, clock)
    assert pacer.remaining_s() == pytest.approx(0.1)


@pytest.mark.parametrize("factor", [-1.0, float("inf"), float("nan")])
def test_nonsense_factors_are_refused(factor):
    with pytest.raises(ValueError, match="real_time_factor must be 0"):
        Pacer(0.01, real_time_factor=factor)


@pytest.mark.parametrize("period_s", [0.0, -0.01, float("nan")])
def test_nonsense_periods_are_refused(period_s):
    with pytest.raises(ValueError, match="period must be positive"):
        Pacer(period_s)


def test_falling_behind_is_logged_at_intervals(caplog):
    clock = ManualClock()
    pacer = Pacer(0.01, clock=clock)
    while clock.now_s() < 0.9 * WARNING_INTERVAL_S:
        run_tick(pacer, clock, 0.02)
    assert caplog.text.count("cannot keep its pace") == 1
    assert "real-time factor 0.50 instead of 1" in caplog.text
    while clock.now_s() < 2.5 * WARNING_INTERVAL_S:
        run_tick(pacer, clock, 0.02)
    assert caplog.text.count("cannot keep its pace") == 3


def test_a_stall_soon_after_a_warning_is_reported_with_the_next(caplog):
    clock = ManualClock()
    pacer = Pacer(0.01, clock=clock)
    run_tick(pacer, clock, 0.1)
    while clock.now_s() < 2.0:
        run_tick(pacer, clock)
    assert caplog.text.count("cannot keep its pace") == 1
    run_tick(pacer, clock, 1.0 + CATCH_UP_S)
    while clock.now_s() < 1.5 * WARNING_INTERVAL_S:
        run_tick(pacer, clock)
    assert caplog.text.count("cannot keep its pace") == 2
    assert "0.990 s were given up" in caplog.text
    # The stall lies in the 9.1 s that it is told of, though a window ended with it.
    assert "real-time factor 0.89 instead of 1" in caplog.text


def test_a_stall_without_effect_on_the_pace_is_reported_as_a_stall(caplog):
    clock = ManualClock()
    pacer = Pacer(0.01, clock=clock)
    clock.advance(CATCH_UP_S + 0.004)
    while clock.now_s() < 2.0:
        run_tick(pacer, clock)
    (said,) = caplog.messages
    assert said == (
        "the control loop was held up: a tick started 54.0 ms late, and 0.004 s were given up"
    )


def test_warnings_can_be_switched_off(caplog):
    clock = ManualClock()
    pacer = Pacer(0.01, clock=clock, print_warnings=False)
    for _ in range(500):
        run_tick(pacer, clock, 0.02)
    assert caplog.text == ""


def test_keeping_up_is_silent(caplog):
    clock = ManualClock()
    pacer = Pacer(0.01, clock=clock)
    for _ in range(500):
        run_tick(pacer, clock, 0.009)
    assert caplog.text == ""


@pytest.mark.parametrize(("factor", "rate_hz"), [(1.0, 100.0), (0.5, 50.0), (0.0, 500.0)])
def test_ticks_are_recorded_in_wall_time(factor, rate_hz):
    clock = ManualClock()
    pacer = Pacer(0.01, real_time_factor=factor, clock=clock)
    for _ in range(20):
        run_tick(pacer, clock, 0.002)
    statistics = pacer.runs.statistics()
    assert statistics is not None
    assert statistics.periodicity_hz is not None
    assert statistics.periodicity_hz.mean == pytest.approx(rate_hz)
    assert statistics.execution_time_us.mean == pytest.approx(2000.0)


def test_a_pause_does_not_count_as_a_long_period():
    clock = ManualClock()
    pacer = Pacer(0.01, clock=clock)
    run_tick(pacer, clock)
    clock.advance(60.0)
    pacer.restart()
    for _ in range(3):
        run_tick(pacer, clock)
    statistics = pacer.runs.statistics()
    assert statistics is not None
    assert statistics.periodicity_hz is not None
    assert statistics.periodicity_hz.minimum == pytest.approx(100.0)


def test_it_permits_once_per_interval():
    clock = ManualClock()
    throttle = Throttle(1.0, clock)
    permits = []
    for _ in range(25):
        permits.append(throttle.permits())
        clock.advance(0.125)
    assert [i for i, permitted in enumerate(permits) if permitted] == [0, 8, 16, 24]
