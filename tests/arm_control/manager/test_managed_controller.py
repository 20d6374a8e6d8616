"""Controllers that run more slowly than the manager."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from arm_control import (
    Controller,
    ControllerContext,
    InterfaceConfiguration,
    ReturnType,
    SwitchRequest,
)
from arm_control.manager.loaded_controllers import ManagedController


class Counter(Controller[Any]):
    """Notes when it runs."""

    def __init__(self, context: ControllerContext) -> None:
        super().__init__(context)
        self.times_s: list[float] = []

    def command_interface_configuration(self) -> InterfaceConfiguration:
        return InterfaceConfiguration.none()

    def state_interface_configuration(self) -> InterfaceConfiguration:
        return InterfaceConfiguration.none()

    def on_configure(self, parameters: object) -> None:
        pass

    def update(self, time_s: float, period_s: float) -> ReturnType:
        self.times_s.append(time_s)
        return ReturnType.OK


def start(bench: Any, rate_hz: int) -> Any:
    probe = bench.configure("slow", commands=("j0/position",), rate_hz=rate_hz)
    bench.manager.switch_controller(SwitchRequest(("slow",)))
    return probe


def rate(bench: Any) -> int:
    return bench.manager.list_controllers()[0].update_rate_hz


def test_by_default_it_runs_at_the_managers_rate(bench):
    probe = start(bench, 0)
    bench.tick(5)
    assert (rate(bench), len(probe.updates)) == (100, 5)


def test_a_divisor_is_kept(bench):
    probe = start(bench, 25)
    bench.tick(12)
    assert rate(bench) == 25
    assert [t for t, _ in probe.updates] == pytest.approx([0.0, 0.04, 0.08])


def test_the_first_cycle_runs_at_once_with_the_nominal_period(bench):
    probe = start(bench, 20)
    bench.tick()
    assert probe.updates == [(0.0, 0.05)]


def test_later_cycles_get_the_period_since_the_last(bench):
    probe = start(bench, 50)
    bench.tick(4)
    assert [p for _, p in probe.updates] == pytest.approx([0.02, 0.02])


@pytest.mark.parametrize(("asked", "given"), [(30, 33), (60, 50), (99, 100), (7, 7)])
def test_a_rate_that_does_not_divide_is_lowered_to_one_that_does(bench, asked, given, caplog):
    start(bench, asked)
    assert rate(bench) == given
    assert ("does not divide" in caplog.text) is (asked != given)


def test_a_rate_above_the_managers_is_the_managers(bench, caplog):
    probe = start(bench, 1000)
    bench.tick(3)
    assert (rate(bench), len(probe.updates)) == (100, 3)
    assert "asks for 1000 Hz; it runs at the controller manager's 100 Hz" in caplog.text


def test_setting_the_time_back_restarts_the_cadence(bench):
    probe = start(bench, 25)
    bench.tick(3)
    bench.time_s = 0.0
    bench.tick(1)
    assert probe.updates[-1] == (0.0, 0.04)


def test_each_activation_begins_with_a_first_cycle(bench):
    probe = start(bench, 10)
    bench.tick(3)
    bench.manager.switch_controller(SwitchRequest(("slow",), ("slow",)))
    probe.updates.clear()
    bench.tick()
    assert [p for _, p in probe.updates] == [0.1]


@given(st.lists(st.floats(0.8e-2, 1.2e-2), min_size=12, max_size=12).map(lambda some: some * 25))
def test_the_mean_rate_is_kept_when_ticks_jitter(periods_s):
    probe = Counter(ControllerContext("slow", 100))
    managed = ManagedController(probe, "test/Counter", (), 100)
    managed.set_update_rate(25)
    time_s = 0.0
    for period_s in periods_s:
        managed.run(time_s, period_s)
        time_s += period_s
    assert np.mean(np.diff(probe.times_s)) == pytest.approx(0.04, rel=0.15)
