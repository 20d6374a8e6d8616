"""The snapshot matches the manager after every change."""

from contextlib import suppress
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from arm_control import ControllerManagerError, LifecycleState, SwitchRequest
from arm_control.hardware.driver import HardwareReturn
from arm_control.manager.introspection import ManagerSnapshot

NAMES = ("a", "b", "c")
STEPS = (
    *(
        f"{verb} {name}"
        for verb in ("configure", "clean", "start", "stop", "fail")
        for name in NAMES
    ),
    *(f"hardware {state.label}" for state in (LifecycleState.INACTIVE, LifecycleState.ACTIVE)),
    *("hardware unconfigured", "break", "deactivate"),
)


def take(step: str, bench: Any, probes: dict[str, Any]) -> None:
    """Do something to a manager, allowed or not."""
    manager = bench.manager
    verb, _, name = step.partition(" ")
    match verb:
        case "configure":
            manager.configure_controller(name, probes[name].asks)
        case "clean":
            manager.cleanup_controller(name)
        case "start":
            manager.switch_controller(SwitchRequest((name,)))
        case "stop":
            manager.switch_controller(SwitchRequest((), (name,)))
        case "fail":
            probes[name].fails_update = True
            bench.tick()
            probes[name].fails_update = False
        case "hardware":
            manager.set_hardware_component_state("FakeSystem", LifecycleState[name.upper()])
        case _:
            outcome = HardwareReturn.ERROR if verb == "break" else HardwareReturn.DEACTIVATE
            bench.hardware.write_result = outcome
            bench.tick()
            bench.hardware.write_result = HardwareReturn.OK


@settings(max_examples=60, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.lists(st.sampled_from(STEPS), max_size=25))
def test_it_is_never_behind(new_bench, steps):
    bench = new_bench()
    snapshot = ManagerSnapshot(bench.manager)
    bench.manager.add_observer(snapshot)
    probes = {}
    for name in NAMES:
        probe = probes[name] = bench.configure(name, commands=(f"j{NAMES.index(name)}/position",))
        probe.asks = type(probe).parameters_type((f"j{NAMES.index(name)}/position",))
    for step in steps:
        with suppress(ControllerManagerError):
            take(step, bench, probes)
        manager = bench.manager
        assert tuple(s for s, _ in snapshot.controllers) == manager.list_controllers()
        assert tuple(s for s, _, _ in snapshot.components) == manager.list_hardware_components()
        assert snapshot.interfaces == manager.list_hardware_interfaces()


@pytest.fixture
def new_bench(bench):
    """Return a function that makes benches like the one of the fixture."""
    return type(bench)


def test_records_of_the_runs_come_with_it(bench):
    snapshot = ManagerSnapshot(bench.manager)
    bench.manager.add_observer(snapshot)
    bench.configure("a", commands=("j0/position",))
    bench.manager.switch_controller(SwitchRequest(("a",)))
    bench.tick(3)
    ((_, runs),) = snapshot.controllers
    ((_, reads, writes),) = snapshot.components
    for record in (runs, reads, writes):
        statistics = record.statistics()
        assert statistics is not None
        assert statistics.execution_time_us.minimum >= 0.0
