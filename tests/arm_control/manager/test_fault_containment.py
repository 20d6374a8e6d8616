"""How far a fault reaches: to whom it belongs, and no further."""

import asyncio
from collections.abc import Callable
from typing import Any, NoReturn

import pytest

from arm_control import ControllerManager, ControllerManagerError, LifecycleState, SwitchRequest
from arm_control.hardware.driver import HardwareReturn
from arm_control.testing import FakeHardware, fake_hardware

NAMES = ("arm", "gripper", "camera")
EVERYBODY = ("arm_mover", "gripper_mover", "camera_watcher", "watcher")
USERS = {
    "arm": {"arm_mover", "watcher"},
    "gripper": {"gripper_mover", "watcher"},
    "camera": {"camera_watcher", "watcher"},
}
COMMANDERS = {"arm": {"arm_mover"}, "gripper": {"gripper_mover"}, "camera": set[str]()}


class Cell:
    """An arm, a gripper and a camera, with controllers that command and read them."""

    def __init__(self, bench: Any) -> None:
        self.bench = bench
        self.hardware: dict[str, FakeHardware] = {
            name: fake_hardware(
                (name,),
                name=name,
                command_interfaces=() if name == "camera" else ("position",),
                state_interfaces=("position",),
            )
            for name in NAMES
        }
        bench.manager = ControllerManager(tuple(self.hardware.values()), 100)
        bench.manager.bring_up()
        for name in ("arm", "gripper"):
            bench.configure(
                f"{name}_mover", commands=(f"{name}/position",), states=(f"{name}/position",)
            )
        bench.configure("camera_watcher", states=("camera/position",))
        bench.configure("watcher", states=tuple(f"{name}/position" for name in NAMES))
        assert bench.manager.switch_controller(SwitchRequest(EVERYBODY)).ok

    @property
    def active(self) -> set[str]:
        """Names of the controllers that run."""
        return {name for name, state in self.bench.states().items() if state == "active"}

    @property
    def components(self) -> dict[str, str]:
        """State of each component."""
        return {c.name: c.state.label for c in self.bench.manager.list_hardware_components()}


@pytest.fixture
def cell(bench) -> Cell:
    """Return the cell with everything running."""
    return Cell(bench)


@pytest.mark.parametrize("broken", [("arm",), ("gripper",), ("camera",), ("arm", "camera"), NAMES])
@pytest.mark.parametrize("result", ["read_result", "write_result"])
def test_an_error_of_hardware_stops_exactly_its_users(cell, broken, result):
    for name in broken:
        setattr(cell.hardware[name], result, HardwareReturn.ERROR)
    cell.bench.tick(2)
    stopped = set().union(*(USERS[name] for name in broken))
    assert cell.active == set(EVERYBODY) - stopped
    assert cell.components == {
        name: "unconfigured" if name in broken else "active" for name in NAMES
    }


@pytest.mark.parametrize("broken", [("arm",), ("camera",), ("arm", "gripper")])
def test_hardware_that_deactivates_itself_stops_exactly_its_commanders(cell, broken):
    for name in broken:
        cell.hardware[name].write_result = HardwareReturn.DEACTIVATE
    cell.bench.tick(2)
    stopped = set().union(*(COMMANDERS[name] for name in broken))
    assert cell.active == set(EVERYBODY) - stopped
    assert cell.components == {name: "inactive" if name in broken else "active" for name in NAMES}


@pytest.mark.parametrize("outcome", [HardwareReturn.ERROR, HardwareReturn.DEACTIVATE])
def test_after_a_fault_all_of_it_can_run_again(cell, outcome):
    cell.hardware["arm"].write_result = outcome
    cell.bench.tick()
    cell.hardware["arm"].write_result = HardwareReturn.OK
    cell.bench.manager.set_hardware_component_state("arm", LifecycleState.ACTIVE)
    stopped = tuple(set(EVERYBODY) - cell.active)
    assert cell.bench.manager.switch_controller(SwitchRequest(stopped)).ok
    cell.bench.tick(2)
    assert cell.active == set(EVERYBODY)


def test_hardware_that_cannot_clean_up_after_its_error_is_finalized(cell):
    cell.hardware["arm"].read_result = HardwareReturn.ERROR
    cell.hardware["arm"].refused.add("on_cleanup")
    cell.bench.tick()
    assert cell.components["arm"] == "finalized"


@pytest.mark.parametrize("step", ["cleanup", "shutdown"])
def test_a_controller_that_raises_on_shutdown_is_unloaded_anyway(bench, caplog, step):
    bench.configure("bad").raises.add(step)
    bench.manager.unload_controller("bad")
    assert bench.states() == {}
    assert f"bad broke in {step}" in caplog.text


def test_each_failed_controller_gets_its_own_fallbacks(bench):
    for name, joint in (("spare0", "j0"), ("spare1", "j1")):
        bench.configure(name, commands=(f"{joint}/position",))
    bad = [
        bench.configure(f"bad{i}", commands=(f"j{i}/position",), fallback_names=(f"spare{i}",))
        for i in (0, 1)
    ]
    bench.manager.switch_controller(SwitchRequest(("bad0", "bad1")))
    for probe in bad:
        probe.fails_update = True
    bench.tick()
    assert bench.states() == {
        "bad0": "inactive",
        "bad1": "inactive",
        "spare0": "active",
        "spare1": "active",
    }


def test_a_controller_may_have_several_fallbacks_one_of_them_running(bench):
    bench.configure("watcher", states=("j0/position",))
    bench.configure("mover", commands=("j0/position",))
    bad = bench.configure("bad", commands=("j0/position",), fallback_names=("mover", "watcher"))
    bench.manager.switch_controller(SwitchRequest(("bad", "watcher")))
    bad.fails_update = True
    bench.tick(2)
    assert bench.states() == {"bad": "inactive", "mover": "active", "watcher": "active"}
    # It went on running, it was not restarted.
    assert bench.events.count("watcher activate") == 1


def test_a_fallback_that_fails_too_is_stopped_in_its_turn(bench):
    bench.configure("spare", commands=("j0/position",)).fails_update = True
    bench.configure("bad", commands=("j0/position",), fallback_names=("spare",)).fails_update = True
    bench.manager.switch_controller(SwitchRequest(("bad",)))
    bench.tick(3)
    assert bench.states() == {"bad": "inactive", "spare": "inactive"}


def test_observers_are_told_of_every_fault(cell, observer):
    cell.bench.manager.add_observer(observer)
    cell.hardware["camera"].read_result = HardwareReturn.ERROR
    cell.bench.tick()
    assert {(name, label) for name, label, _, _ in observer.transitions} == {
        ("camera_watcher", "deactivate"),
        ("watcher", "deactivate"),
    }
    assert observer.changes > 0


@pytest.mark.parametrize("step", ["configure", "activate", "deactivate", "cleanup"])
def test_a_controller_that_raises_in_a_transition_is_reported_and_claims_nothing(bench, step):
    manager, probe = bench.manager, bench.load("a")
    probe.raises.add(step)
    said: list[str] = []
    try:
        manager.configure_controller("a", probe.parameters_type(("j0/position",)))
        said.append(manager.switch_controller(SwitchRequest(("a",))).message)
        said.append(manager.switch_controller(SwitchRequest((), ("a",))).message)
        manager.cleanup_controller("a")
    except ControllerManagerError as error:
        said.append(str(error))
    reasons = (f"a broke in {step}", f"Unable to {step} controllers: [ a ]")
    assert any(reason in message for reason in reasons for message in said), said
    assert bench.states() == {"a": "inactive" if step == "cleanup" else "unconfigured"}
    assert manager.resources.claimant("j0/position") is None


def test_a_thousand_switches_leave_one_holder(bench):
    names = ["a", "b"]
    for name in names:
        bench.configure(name, commands=("j0/position",))
    for _ in range(1000):
        started, stopped = names
        assert bench.manager.switch_controller(SwitchRequest((started,), (stopped,))).ok
        bench.tick()
        assert bench.manager.resources.claimant("j0/position") == started
        names.reverse()
    assert bench.states() == {"a": "inactive", "b": "active"}


# Not an Exception, such as the SystemExit of a vendor's library


def raising(error: BaseException) -> Callable[..., NoReturn]:
    def function(*_: object) -> NoReturn:
        raise error

    return function


@pytest.fixture(params=[SystemExit, asyncio.CancelledError])
def raised(request) -> BaseException:
    return request.param(1)


@pytest.mark.parametrize("exchange", ["read", "write"])
def test_hardware_that_wants_to_end_the_process_is_taken_down(cell, raised, exchange, caplog):
    setattr(cell.hardware["arm"], exchange, raising(raised))
    cell.bench.tick(2)
    assert cell.components["arm"] == "unconfigured"
    assert cell.active == set(EVERYBODY) - USERS["arm"]
    assert "hardware component 'arm' failed" in caplog.text
    assert type(raised).__name__ in caplog.text


def test_a_life_cycle_step_that_wants_to_end_the_process_has_failed(cell, raised):
    cell.hardware["arm"].on_deactivate = raising(raised)
    reason = f"on_deactivate of hardware component 'arm' raised {type(raised).__name__}"
    with pytest.raises(ControllerManagerError, match=reason):
        cell.bench.manager.set_hardware_component_state("arm", LifecycleState.INACTIVE)


def test_a_controller_that_wants_to_end_the_process_is_stopped(bench, raised, caplog):
    bench.configure("bad", commands=("j0/position",)).update = raising(raised)
    bench.manager.switch_controller(SwitchRequest(("bad",)))
    bench.tick()
    assert bench.states() == {"bad": "inactive"}
    assert "controller 'bad' raised in its update" in caplog.text
    assert type(raised).__name__ in caplog.text


def test_ctrl_c_is_not_a_failure(cell):
    for name in ("read", "on_deactivate"):
        setattr(cell.hardware["arm"], name, raising(KeyboardInterrupt()))
    with pytest.raises(KeyboardInterrupt):
        cell.bench.tick()
    with pytest.raises(KeyboardInterrupt):
        cell.bench.manager.set_hardware_component_state("arm", LifecycleState.INACTIVE)
