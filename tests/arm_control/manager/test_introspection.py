"""The named values of a manager."""

import numpy as np
import pytest

from arm_control import SwitchRequest
from arm_control.manager.introspection import InterfaceValues, ManagerSnapshot, ManagerStatistics


@pytest.fixture
def snapshot(bench) -> ManagerSnapshot:
    snapshot = ManagerSnapshot(bench.manager)
    bench.manager.add_observer(snapshot)
    return snapshot


def test_every_interface_has_its_value(bench, snapshot):
    values = InterfaceValues(bench.manager, snapshot)
    bench.manager.resources.states[:] = np.arange(len(bench.manager.resources.states))
    bench.manager.resources.commands[:] = -1.0
    sample = values.sample()
    shown = dict(zip(sample.names, sample.values.tolist(), strict=True))
    commands, states = bench.manager.list_hardware_interfaces()
    assert set(shown) == {
        *(f"command_interface.{item.name}" for item in commands),
        *(f"state_interface.{item.name}" for item in states),
    }
    states_in_order = [name for name in shown if name.startswith("state_interface.")]
    assert sorted(shown[name] for name in states_in_order) == list(range(len(states)))
    assert {v for name, v in shown.items() if name.startswith("command_interface.")} == {-1.0}


def test_a_sample_is_a_copy_and_its_names_stay(bench, snapshot):
    values = InterfaceValues(bench.manager, snapshot)
    first = values.sample()
    kept = first.values.copy()
    bench.manager.resources.states[:] = 77.0
    assert np.array_equal(first.values, kept, equal_nan=True)
    assert values.sample().names is first.names


def test_the_figures_are_those_of_the_runs(bench, snapshot):
    bench.configure("a", commands=("j0/position",))
    assert bench.manager.switch_controller(SwitchRequest(("a",))).ok
    for _ in range(5):
        bench.tick()
    statistics = ManagerStatistics(bench.manager, snapshot, "controller_manager")
    sample = statistics.sample()
    shown = dict(zip(sample.names, sample.values.tolist(), strict=True))
    runs = dict((status.name, runs) for status, runs in snapshot.controllers)["a"].statistics()
    assert runs is not None
    assert runs.periodicity_hz is not None
    assert shown["a.stats/execution_time/average"] == runs.execution_time_us.mean
    assert shown["a.stats/periodicity/average"] == runs.periodicity_hz.mean
    assert shown["a.stats/execution_time/current_value"] > 0.0
    assert shown["a.stats/periodicity/current_value"] > 0.0
    assert shown["controller_manager.total_time"] >= shown["controller_manager.update_time"] > 0.0
    (component, *_), *_ = snapshot.components
    assert f"{component.name}.stats/write_cycle/execution_time/standard_deviation" in shown
    assert statistics.sample().names is sample.names


def test_what_never_ran_has_no_figures(bench, snapshot):
    bench.configure("a", commands=("j0/position",))
    sample = ManagerStatistics(bench.manager, snapshot, "controller_manager").sample()
    shown = dict(zip(sample.names, sample.values.tolist(), strict=True))
    assert np.isnan([v for name, v in shown.items() if name.startswith("a.stats")]).all()
