"""One cycle with hardware that follows the clock."""

from typing import Any

import pytest

from arm_control import SwitchRequest
from arm_control.loop.clock import SystemClock
from arm_control.manager.controller_manager import ControlCycle
from arm_control.testing import ManualClock


def test_states_come_first_and_commands_leave_before_the_broadcasters(bench):
    seen = bench.events
    hardware = bench.hardware
    read, write = hardware.read, hardware.write

    def noted(what: str, exchange: Any) -> Any:
        def call(time_s: float, period_s: float) -> Any:
            seen.append(what)
            return exchange(time_s, period_s)

        return call

    hardware.read, hardware.write = noted("read", read), noted("write", write)
    bench.configure("watcher", states=("j0/position",))
    bench.configure("mover", commands=("j0/position",))
    bench.manager.switch_controller(SwitchRequest(("watcher", "mover")))
    seen.clear()
    ControlCycle(bench.manager, ManualClock(5.0))()
    assert seen == ["read", "mover update", "write", "watcher update"]


def test_the_period_is_the_time_since_the_last_cycle(bench):
    mover = bench.configure("mover", commands=("j0/position",))
    bench.manager.switch_controller(SwitchRequest(("mover",)))
    clock = ManualClock(100.0)
    cycle = ControlCycle(bench.manager, clock)
    for step_s in (0.0, 0.012, 0.009):
        clock.advance(step_s)
        cycle()
    times_s, periods_s = zip(*mover.updates, strict=True)
    assert times_s == pytest.approx((100.0, 100.012, 100.021))
    assert periods_s == pytest.approx((0.01, 0.012, 0.009))


@pytest.mark.parametrize("step_s", [0.0, -50.0])
def test_where_time_does_not_advance_the_period_is_nominal(bench, step_s):
    mover = bench.configure("mover", commands=("j0/position",))
    bench.manager.switch_controller(SwitchRequest(("mover",)))
    clock = ManualClock(100.0)
    cycle = ControlCycle(bench.manager, clock)
    cycle()
    clock.advance(step_s)
    cycle()
    assert mover.updates[-1] == (100.0 + step_s, 0.01)


@pytest.mark.parametrize("step_s", [3600.0, -3600.0])
def test_a_date_that_is_set_changes_no_period(bench, step_s):
    every, second = (
        bench.configure(name, commands=(f"{joint}/position",), rate_hz=rate_hz)
        for name, joint, rate_hz in (("every", "j0", 100), ("second", "j1", 50))
    )
    bench.manager.switch_controller(SwitchRequest(("every", "second")))
    date, ticker = ManualClock(1.7e9), ManualClock(5.0)
    cycle = ControlCycle(bench.manager, date, ticker)
    for date_step_s in (0.01, 0.01, 0.01 + step_s, 0.01, 0.01):
        date.advance(date_step_s)
        ticker.advance(0.01)
        cycle()
    assert [p for _, p in every.updates] == pytest.approx([0.01] * 5)
    assert [p for _, p in second.updates] == pytest.approx([0.02] * 3)
    assert every.updates[-1][0] == pytest.approx(1.7e9 + 0.05 + step_s)
    # Nor do the statistics of /diagnostics know another one.
    records = [runs for _, runs in bench.manager.controller_runs()]
    records += [runs for _, *both in bench.manager.resources.component_runs() for runs in both]
    for record in (*records, bench.manager.updates):
        rate = record.statistics().periodicity_hz
        assert rate.minimum == pytest.approx(rate.maximum)


def test_the_system_clock_is_the_date():
    assert SystemClock().now_s() > 1.6e9
