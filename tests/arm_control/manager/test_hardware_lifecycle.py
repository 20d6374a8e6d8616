"""Components in the manager's care: start, states, failures."""

import dataclasses
from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest

from arm_control import ControllerManager, ControllerManagerError, LifecycleState, SwitchRequest
from arm_control.hardware.driver import HardwareReturn
from arm_control.hardware.info import HardwareInfo
from arm_control.manager.controller_switcher import PREPARE_REJECTED
from arm_control.manager.settings import ManagerPolicy
from arm_control.testing import FakeHardware, fake_hardware

ALL = ("j0/position", "j1/position", "j2/position", "j3/position")
MODES = ("position", "velocity")


def test_bring_up_activates_all_and_reads_once():
    hardware = fake_hardware(initial_positions={"j2": 0.7})
    manager = ControllerManager([hardware], 100)
    assert np.isnan(manager.resources.states).all()
    manager.bring_up()
    assert hardware.events == ["on_configure", "on_activate"]
    assert manager.resources.states.reshape(4, 3)[:, 0].tolist() == [0.0, 0.0, 0.7, 0.0]


def test_bring_up_leaves_components_in_their_initial_states():
    names = ("A", "B", "C")
    hardware = [fake_hardware((f"{name}1",), name=name) for name in names]
    manager = ControllerManager(hardware, 100)
    manager.bring_up(unconfigured=["A"], inactive=["B"])
    assert [c.state.label for c in manager.list_hardware_components()] == [
        "unconfigured",
        "inactive",
        "active",
    ]


def test_bring_up_names_the_component_that_does_not_exist(bench):
    with pytest.raises(
        ControllerManagerError, match="no hardware component 'X'; the components are FakeSys"
    ):
        bench.manager.bring_up(inactive=["X"])


def test_bring_up_says_which_step_failed():
    hardware = fake_hardware()
    hardware.refused.add("on_activate")
    with pytest.raises(ControllerManagerError, match="on_activate of hardware component 'FakeSys"):
        ControllerManager([hardware], 100).bring_up()


def grouped(*names: str) -> list[FakeHardware]:
    """Return components of one group that write their steps into one list, and one outside."""
    steps: list[str] = []
    components = [fake_hardware((f"{name}1",), name=name) for name in (*names, "Alone")]
    for component in components:
        group = "" if component.info.name == "Alone" else "arms"
        component.info = dataclasses.replace(component.info, group=group)
        component.events = steps
    return components


def test_a_group_is_configured_before_any_of_it_is_activated():
    hardware = grouped("A", "B")
    ControllerManager(hardware, 100).bring_up()
    configure, activate = "on_configure", "on_activate"
    assert hardware[0].events == [configure, configure, activate, activate, configure, activate]


def test_where_one_of_a_group_fails_all_go_back():
    hardware = grouped("A", "B")
    hardware[1].refused.add("on_activate")
    policy = ManagerPolicy(end_on_initial_state_failure=False)
    manager = ControllerManager(hardware, 100, policy)
    manager.bring_up()
    states = [c.state.label for c in manager.list_hardware_components()]
    assert states == ["unconfigured", "unconfigured", "active"]


def test_the_update_rate_must_be_positive():
    with pytest.raises(ControllerManagerError, match="update_rate must be positive, not 0"):
        ControllerManager([], 0)


@pytest.mark.parametrize("result", ["read_result", "write_result"])
def test_hardware_that_fails_goes_down_with_its_users_only(result, caplog, bench):
    other = fake_hardware(("k0",), name="Other")
    bench.manager = ControllerManager([bench.hardware, other], 100)
    bench.manager.bring_up()
    bench.configure("user", commands=("j0/position",))
    bench.configure("watcher", states=("j1/velocity",))
    bench.configure("bystander", commands=("k0/position",))
    bench.manager.switch_controller(SwitchRequest(("user", "watcher", "bystander")))
    setattr(bench.hardware, result, HardwareReturn.ERROR)
    bench.tick()
    assert bench.states() == {"bystander": "active", "watcher": "inactive", "user": "inactive"}
    assert [c.state.label for c in bench.manager.list_hardware_components()] == [
        "unconfigured",
        "active",
    ]
    assert "resulted in an error: [ FakeSystem ]" in caplog.text


def test_hardware_that_raises_counts_as_failed(bench, caplog):
    def broken(time_s: float, period_s: float) -> HardwareReturn:
        raise OSError("cable out")

    bench.hardware.read = broken
    bench.tick()
    (component,) = bench.manager.list_hardware_components()
    assert component.state is LifecycleState.UNCONFIGURED
    assert "cable out" in caplog.text


def test_hardware_that_failed_comes_back_with_its_interfaces(bench):
    bench.configure("a", commands=ALL)
    bench.manager.switch_controller(SwitchRequest(("a",)))
    bench.hardware.read_result = HardwareReturn.ERROR
    bench.tick()
    refused = bench.manager.switch_controller(SwitchRequest(("a",)))
    bench.hardware.read_result = HardwareReturn.OK
    bench.manager.set_hardware_component_state("FakeSystem", LifecycleState.ACTIVE)
    accepted = bench.manager.switch_controller(SwitchRequest(("a",)))
    assert "'j0/position' is not available" in refused.message
    assert accepted.ok


def test_hardware_that_deactivates_itself_stops_only_its_commanders(bench):
    bench.configure("user", commands=ALL)
    bench.configure("watcher", states=("j1/velocity",))
    bench.manager.switch_controller(SwitchRequest(("user", "watcher")))
    bench.hardware.write_result = HardwareReturn.DEACTIVATE
    bench.tick()
    assert bench.states() == {"watcher": "active", "user": "inactive"}
    (component,) = bench.manager.list_hardware_components()
    assert component.state is LifecycleState.INACTIVE


@pytest.mark.parametrize("stops_users", [True, False])
def test_hardware_that_fails_to_deactivate_itself_is_taken_down_once(bench, caplog, stops_users):
    bench.hardware = fake_hardware()
    policy = ManagerPolicy(stop_with_self_deactivated_hardware=stops_users)
    bench.manager = ControllerManager([bench.hardware], 100, policy)
    bench.manager.bring_up()
    bench.configure("user", commands=ALL)
    bench.configure("watcher", states=("j1/velocity",))
    bench.manager.switch_controller(SwitchRequest(("user", "watcher")))
    bench.hardware.refused.add("on_deactivate")
    bench.hardware.write_result = HardwareReturn.DEACTIVATE
    bench.tick(3)
    assert bench.states() == {"watcher": "inactive", "user": "inactive"}
    (component,) = bench.manager.list_hardware_components()
    assert component.state is LifecycleState.UNCONFIGURED
    assert bench.hardware.events[2:] == ["on_deactivate", "on_cleanup"]
    assert caplog.text.count("'FakeSystem' deactivates itself") == 1
    assert caplog.text.count("on_deactivate of hardware component 'FakeSystem' returned False") == 1


def test_inactive_hardware_may_keep_requesting_deactivation(bench, observer, caplog):
    bench.hardware.read_result = HardwareReturn.DEACTIVATE
    bench.tick()
    assert caplog.text.count("'FakeSystem' deactivates itself") == 1
    changes = observer.changes
    bench.tick(3)
    assert caplog.text.count("'FakeSystem' deactivates itself") == 1
    assert observer.changes == changes
    (component,) = bench.manager.list_hardware_components()
    assert component.state is LifecycleState.INACTIVE


def test_inactive_hardware_is_read_but_not_written(bench):
    bench.configure("a", commands=ALL)
    bench.manager.switch_controller(SwitchRequest(("a",)))
    bench.manager.set_hardware_component_state("FakeSystem", LifecycleState.INACTIVE)
    bench.manager.resources.commands[:] = 1.0
    bench.tick()
    assert bench.states() == {"a": "active"}
    assert bench.manager.resources.states.reshape(4, 3)[:, 0].tolist() == [0.0] * 4


def test_cleaning_hardware_up_stops_its_users(bench):
    bench.configure("a", commands=ALL)
    bench.manager.switch_controller(SwitchRequest(("a",)))
    bench.manager.set_hardware_component_state("FakeSystem", LifecycleState.UNCONFIGURED)
    assert bench.states() == {"a": "inactive"}
    commands, states = bench.manager.list_hardware_interfaces()
    assert not any(i.is_available for i in (*commands, *states))


def test_finalized_hardware_stays_finalized(bench):
    bench.manager.set_hardware_component_state("FakeSystem", LifecycleState.FINALIZED)
    with pytest.raises(ControllerManagerError, match="is finalized"):
        bench.manager.set_hardware_component_state("FakeSystem", LifecycleState.ACTIVE)


def test_two_components_of_one_name_are_refused():
    with pytest.raises(ControllerManagerError, match="two hardware components are named 'Fake"):
        ControllerManager([fake_hardware(), fake_hardware(("k0",))], 100)


def test_two_components_with_the_same_interface_are_refused():
    with pytest.raises(ControllerManagerError, match=r"already belongs to .*'FakeSystem'"):
        ControllerManager([fake_hardware(), fake_hardware(("j0",), name="B")], 100)


class Visited(FakeHardware):
    """Fake hardware that notes when it is read and written, and with which period."""

    def __init__(self, info: HardwareInfo) -> None:
        super().__init__(info)
        self.visits: list[tuple[str, float, float]] = []

    def read(self, time_s: float, period_s: float) -> HardwareReturn:
        self.visits.append(("read", time_s, period_s))
        return super().read(time_s, period_s)

    def write(self, time_s: float, period_s: float) -> HardwareReturn:
        self.visits.append(("write", time_s, period_s))
        return super().write(time_s, period_s)


def visited(rate_hz: int, **changes: Any) -> tuple[ControllerManager, Visited]:
    info = dataclasses.replace(fake_hardware().info, read_write_rate_hz=rate_hz, **changes)
    hardware = Visited(info)
    manager = ControllerManager([hardware], 100)
    manager.bring_up()
    hardware.visits.clear()
    return manager, hardware


def test_a_component_is_read_and_written_at_its_own_rate():
    manager, hardware = visited(25)
    # A clock that does not begin at zero: the first cycle is one of its own all the same.
    for cycle in range(100, 110):
        manager.read(cycle / 100, 0.01)
        manager.write(cycle / 100, 0.01)
    for exchange in ("read", "write"):
        visits = [(t, p) for name, t, p in hardware.visits if name == exchange]
        assert [t for t, _ in visits] == pytest.approx([1.0, 1.04, 1.08])
        assert [p for _, p in visits] == pytest.approx([0.04] * 3)
    (component,) = manager.list_hardware_components()
    assert component.read_write_rate_hz == 25


@pytest.mark.parametrize(("rate_hz", "period_s"), [(0, 0.01), (25, 0.04)])
def test_a_driver_may_divide_by_the_period_of_its_very_first_read(rate_hz, period_s):
    hardware = Visited(dataclasses.replace(fake_hardware().info, read_write_rate_hz=rate_hz))
    ControllerManager([hardware], 100).bring_up()
    assert hardware.visits == [("read", 0.0, period_s)]


@pytest.mark.parametrize(
    ("asked", "given", "says"),
    [
        (0, 100, ""),
        (30, 33, "hardware component 'FakeSystem' asks for 30 Hz, which does not divide"),
        (500, 100, "asks for 500 Hz; it runs at the controller manager's 100 Hz"),
    ],
)
def test_the_rate_shown_is_the_one_that_it_runs_at(asked, given, says, caplog):
    manager, _ = visited(asked)
    (component,) = manager.list_hardware_components()
    assert component.read_write_rate_hz == given
    assert says in caplog.text
    assert bool(says) is bool(caplog.records)


class OneMode(FakeHardware):
    """Lets a joint be commanded by one interface at a time."""

    def __init__(self) -> None:
        super().__init__(fake_hardware(("j0", "j1"), command_interfaces=MODES).info)
        self.held: set[str] = set()

    def prepare_command_mode_switch(self, start: Sequence[str], stop: Sequence[str]) -> bool:
        joints = [name.split("/")[0] for name in (self.held - set(stop)) | set(start)]
        return len(joints) == len(set(joints))

    def perform_command_mode_switch(self, start: Sequence[str], stop: Sequence[str]) -> bool:
        self.held = self.held - set(stop) | set(start)
        return super().perform_command_mode_switch(start, stop)


def test_a_joint_that_has_one_mode_at_a_time_changes_it_in_one_request(bench):
    hardware = OneMode()
    bench.manager = manager = ControllerManager([hardware], 100)
    manager.bring_up()
    for name, interface in (("places", "position"), ("speeds", "velocity")):
        bench.configure(name, commands=(f"j0/{interface}",))
    bench.configure("other_joint", commands=("j1/velocity",))
    both = manager.switch_controller(SwitchRequest(("places", "speeds")))
    assert (both.ok, both.message) == (False, PREPARE_REJECTED)
    assert manager.switch_controller(SwitchRequest(("places", "other_joint"))).ok
    assert manager.switch_controller(SwitchRequest(("speeds",))).message == PREPARE_REJECTED
    assert manager.switch_controller(SwitchRequest(("speeds",), ("places",))).ok
    assert manager.switch_controller(SwitchRequest(("places",))).message == PREPARE_REJECTED
    assert hardware.held == {"j0/velocity", "j1/velocity"}
    assert manager.switch_controller(SwitchRequest((), ("speeds",))).ok
    assert manager.switch_controller(SwitchRequest(("places",))).ok
    assert hardware.held == {"j0/position", "j1/velocity"}


def test_interfaces_are_listed_with_the_type_of_the_description():
    hardware = fake_hardware(("j0",))
    joint = hardware.info.joints[0]
    named = {i.name: dataclasses.replace(i, data_type="bool") for i in joint.command_interfaces}
    joint = dataclasses.replace(
        joint, command_interfaces=tuple(named.values()), state_interfaces=()
    )
    hardware.info = dataclasses.replace(hardware.info, joints=(joint,))
    commands, states = ControllerManager([hardware], 100).list_hardware_interfaces()
    assert {i.data_type for i in commands} == {"bool"}
    assert {i.name: i.data_type for i in states}["j0/velocity"] == "double"


def test_a_component_with_is_async_gets_a_warning(caplog):
    manager, hardware = visited(0, is_async=True)
    (component,) = manager.list_hardware_components()
    assert component.is_async
    assert "'FakeSystem' has is_async set; it runs on the control loop's thread here" in caplog.text
    manager.read(0.0, 0.01)
    assert [name for name, _, _ in hardware.visits] == ["read"]
