"""Life cycle, order of a tick, and what happens when something fails."""

import logging
from typing import Any

import numpy as np
import pytest

from arm_control import (
    Controller,
    ControllerManager,
    ControllerManagerError,
    InterfaceConfiguration,
    LifecycleState,
    ReturnType,
    SwitchRequest,
)
from arm_control.forward_command_controller import (
    JointGroupPositionController,
    PositionGroupParameters,
)
from arm_control.hardware import HardwareReturn
from arm_control.testing import fake_hardware

ALL = ("j0/position", "j1/position", "j2/position", "j3/position")


# Loading and the life cycle


def test_a_loaded_controller_is_unconfigured(bench: Any) -> None:
    bench.load("a")
    assert bench.states() == {"a": "unconfigured"}


def test_the_newest_controller_is_listed_first(bench: Any) -> None:
    bench.load("a")
    bench.load("b")
    assert list(bench.states()) == ["b", "a"]


def test_a_name_is_loaded_only_once(bench: Any) -> None:
    bench.load("a")
    with pytest.raises(ControllerManagerError, match="'a' was already loaded"):
        bench.load("a")


def test_a_controller_is_no_fallback_of_itself(bench: Any) -> None:
    with pytest.raises(ControllerManagerError, match="own fallback"):
        bench.load("a", fallback_names=("a",))


def test_configure_makes_it_inactive(bench: Any) -> None:
    bench.configure("a")
    assert bench.states() == {"a": "inactive"}


def test_configure_of_an_unknown_name_says_what_is_loaded(bench: Any) -> None:
    bench.load("a")
    with pytest.raises(ControllerManagerError, match=r"no controller with this name.*loaded: a"):
        bench.manager.configure_controller("b", None)


def test_an_inactive_controller_is_cleaned_up_before_it_is_configured_again(bench: Any) -> None:
    probe = bench.configure("a")
    bench.manager.configure_controller("a", probe.parameters_type())
    assert bench.events == ["a configure", "a cleanup", "a configure"]


def test_an_active_controller_is_not_configured(bench: Any) -> None:
    probe = bench.configure("a")
    bench.manager.switch_controller(SwitchRequest(("a",)))
    with pytest.raises(ControllerManagerError, match="can not be configured from 'active' state"):
        bench.manager.configure_controller("a", probe.parameters_type())


@pytest.mark.parametrize("way", ["refuses", "raises"])
def test_a_failing_configure_leaves_it_unconfigured_with_its_reason(bench: Any, way: str) -> None:
    probe = bench.load("a")
    getattr(probe, way).add("configure")
    with pytest.raises(ControllerManagerError, match=r"does not want to|broke in configure"):
        bench.manager.configure_controller("a", probe.parameters_type())
    assert bench.states() == {"a": "unconfigured"}


@pytest.mark.parametrize("kind", ["commands", "states"])
def test_an_interface_asked_for_twice_fails_the_configuration(bench: Any, kind: str) -> None:
    with pytest.raises(ControllerManagerError, match=r"more than once .* j0/position"):
        bench.configure("a", **{kind: ("j0/position", "j1/position", "j0/position")})
    assert bench.states() == {"a": "unconfigured"}


def test_cleanup_takes_an_inactive_controller_back(bench: Any) -> None:
    bench.configure("a", commands=ALL)
    bench.manager.cleanup_controller("a")
    (status,) = bench.manager.list_controllers()
    assert (status.state, status.required_command_interfaces) == (LifecycleState.UNCONFIGURED, ())


def test_cleanup_of_an_unconfigured_controller_does_nothing(bench: Any) -> None:
    bench.load("a")
    bench.manager.cleanup_controller("a")
    assert bench.events == []


def test_an_active_controller_is_not_cleaned_up(bench: Any) -> None:
    bench.configure("a")
    bench.manager.switch_controller(SwitchRequest(("a",)))
    with pytest.raises(ControllerManagerError, match="cleaned-up from 'active'"):
        bench.manager.cleanup_controller("a")


def test_unload_cleans_up_shuts_down_and_forgets(bench: Any) -> None:
    bench.configure("a")
    bench.manager.unload_controller("a")
    assert bench.events == ["a configure", "a cleanup", "a shutdown"]
    assert bench.states() == {}


def test_an_active_controller_is_not_unloaded(bench: Any) -> None:
    bench.configure("a")
    bench.manager.switch_controller(SwitchRequest(("a",)))
    with pytest.raises(ControllerManagerError, match="still active"):
        bench.manager.unload_controller("a")


def test_the_same_name_can_be_loaded_again_after_unload(bench: Any) -> None:
    bench.configure("a")
    bench.manager.unload_controller("a")
    bench.load("a")
    assert bench.states() == {"a": "unconfigured"}


def test_shutdown_finalizes_controllers_then_hardware(bench: Any) -> None:
    bench.configure("a", commands=ALL)
    bench.manager.switch_controller(SwitchRequest(("a",)))
    bench.events.clear()
    bench.manager.shutdown()
    assert bench.events == ["a deactivate", "a cleanup", "a shutdown"]
    assert bench.hardware.events[-1] == "on_shutdown"
    (component,) = bench.manager.list_hardware_components()
    assert component.state is LifecycleState.FINALIZED


# What clients see


def test_interfaces_are_required_when_configured_and_claimed_when_active(bench: Any) -> None:
    bench.configure("a", commands=ALL, states=("j0/velocity",))
    (inactive,) = bench.manager.list_controllers()
    bench.manager.switch_controller(SwitchRequest(("a",)))
    (active,) = bench.manager.list_controllers()
    assert inactive.required_command_interfaces == active.required_command_interfaces == ALL
    assert inactive.required_state_interfaces == ("j0/velocity",)
    assert (inactive.claimed_interfaces, active.claimed_interfaces) == ((), ALL)


def test_hardware_interfaces_are_sorted_and_show_claims(bench: Any) -> None:
    bench.configure("a", commands=("j1/position",))
    bench.manager.switch_controller(SwitchRequest(("a",)))
    commands, states = bench.manager.list_hardware_interfaces()
    assert [(c.name, c.is_available, c.is_claimed) for c in commands] == [
        ("j0/position", True, False),
        ("j1/position", True, True),
        ("j2/position", True, False),
        ("j3/position", True, False),
    ]
    assert [s.name for s in states[:3]] == ["j0/effort", "j0/position", "j0/velocity"]
    assert not any(s.is_claimed for s in states)


def test_components_are_listed_with_plugin_type_state_and_rate(bench: Any) -> None:
    (component,) = bench.manager.list_hardware_components()
    assert (component.name, component.type) == ("FakeSystem", "system")
    assert component.plugin == "mock_components/GenericSystem"
    assert component.state is LifecycleState.ACTIVE
    assert component.read_write_rate_hz == 100


def test_every_transition_is_reported(bench: Any, observer: Any) -> None:
    bench.configure("a")
    bench.manager.switch_controller(SwitchRequest(("a",)))
    bench.manager.switch_controller(SwitchRequest((), ("a",)))
    bench.manager.unload_controller("a")
    s = LifecycleState
    assert observer.transitions == [
        ("a", "configure", s.UNCONFIGURED, s.INACTIVE),
        ("a", "activate", s.INACTIVE, s.ACTIVE),
        ("a", "deactivate", s.ACTIVE, s.INACTIVE),
        ("a", "cleanup", s.INACTIVE, s.UNCONFIGURED),
        ("a", "shutdown", s.UNCONFIGURED, s.FINALIZED),
    ]


def test_a_transition_that_fails_is_reported_as_going_nowhere(bench: Any, observer: Any) -> None:
    bench.configure("a").refuses.add("activate")
    bench.manager.switch_controller(SwitchRequest(("a",)))
    s = LifecycleState
    assert observer.transitions[-1] == ("a", "activate", s.INACTIVE, s.INACTIVE)


def test_one_activity_per_change_of_controllers(bench: Any, observer: Any) -> None:
    bench.configure("a")
    before = observer.changes
    bench.manager.switch_controller(SwitchRequest(("a",)))
    assert observer.changes == before + 1


def test_a_tick_without_changes_reports_nothing(bench: Any, observer: Any) -> None:
    bench.configure("a", commands=ALL)
    bench.manager.switch_controller(SwitchRequest(("a",)))
    before = observer.changes
    bench.tick(10)
    assert observer.changes == before


# One tick


class Follower(Controller[Any]):
    """Publishes the state that it reads."""

    def __init__(self, *arguments: Any) -> None:
        super().__init__(*arguments)
        self.published: list[float] = []

    def command_interface_configuration(self) -> InterfaceConfiguration:
        return InterfaceConfiguration.none()

    def state_interface_configuration(self) -> InterfaceConfiguration:
        return InterfaceConfiguration.individual(["j0/position"])

    def on_configure(self, parameters: object) -> None:
        pass

    def update(self, time_s: float, period_s: float) -> ReturnType:
        self.published.append(float(self.states.read()[0]))
        return ReturnType.OK


def test_a_command_is_visible_in_the_very_next_publish(bench: Any, make: Any) -> None:
    follower = make(Follower, None)
    position = JointGroupPositionController(follower.context)
    position.name = "position"
    bench.manager.load_controller(position, "position_controllers/JointGroupPositionController")
    bench.manager.configure_controller("position", PositionGroupParameters(joints=("j0",)))
    bench.manager.switch_controller(SwitchRequest(("it", "position")))
    bench.tick()
    position.offer([0.5])
    bench.tick()
    assert follower.published == [0.0, 0.5]


def test_commanding_controllers_run_in_update_and_others_in_publish(bench: Any) -> None:
    bench.configure("commands", commands=ALL)
    bench.configure("watches", states=("j0/position",))
    bench.manager.switch_controller(SwitchRequest(("commands", "watches")))
    bench.events.clear()
    bench.manager.update(0.0, 0.01)
    assert bench.events == ["commands update"]
    bench.manager.publish(0.01, 0.01)
    assert bench.events == ["commands update", "watches update"]


def test_update_gets_time_and_period(bench: Any) -> None:
    probe = bench.configure("a", commands=ALL)
    bench.manager.switch_controller(SwitchRequest(("a",)))
    bench.tick(2)
    assert probe.updates == [(0.0, 0.01), (0.01, 0.01)]


def test_an_inactive_controller_is_not_updated(bench: Any) -> None:
    probe = bench.configure("a", commands=ALL)
    bench.tick()
    assert probe.updates == []


def test_states_are_read_only_for_controllers(bench: Any) -> None:
    probe = bench.configure("a", states=("j0/position", "j1/position"))
    bench.manager.switch_controller(SwitchRequest(("a",)))
    with pytest.raises(ValueError, match="read-only"):
        probe.states.read()[0] = 1.0


# Failing controllers


@pytest.mark.parametrize("how", ["returns ERROR", "raises"])
@pytest.mark.parametrize("commands", [ALL, ()])
def test_a_controller_whose_update_fails_is_deactivated(
    bench: Any, how: str, commands: tuple[str, ...], caplog: pytest.LogCaptureFixture
) -> None:
    probe = bench.configure("bad", commands=commands, states=("j0/position",))
    good = bench.configure("good", states=("j0/position",))
    bench.manager.switch_controller(SwitchRequest(("bad", "good")))
    if how == "raises":
        probe.raises.add("update")
    else:
        probe.fails_update = True
    bench.tick(2)
    assert bench.states() == {"good": "active", "bad": "inactive"}
    assert (len(probe.updates), len(good.updates)) == (1, 2)
    assert "Deactivating controllers : [ bad ] as their update resulted in an error!" in caplog.text
    assert "activate again with: spawner bad" in caplog.text


def test_a_failed_controller_gives_its_interfaces_back(bench: Any) -> None:
    bench.configure("bad", commands=ALL).fails_update = True
    bench.configure("next", commands=ALL)
    bench.manager.switch_controller(SwitchRequest(("bad",)))
    bench.tick()
    assert bench.hardware.mode_switches[-1] == ((), ALL)
    assert bench.manager.switch_controller(SwitchRequest(("next",))).ok


def test_a_failed_controller_can_be_activated_again(bench: Any) -> None:
    probe = bench.configure("bad", commands=ALL)
    probe.fails_update = True
    bench.manager.switch_controller(SwitchRequest(("bad",)))
    bench.tick()
    probe.fails_update = False
    assert bench.manager.switch_controller(SwitchRequest(("bad",))).ok
    bench.tick()
    assert bench.states() == {"bad": "active"}


def test_a_controller_that_raises_leaves_its_traceback(
    bench: Any, caplog: pytest.LogCaptureFixture
) -> None:
    bench.configure("bad", commands=ALL).raises.add("update")
    bench.manager.switch_controller(SwitchRequest(("bad",)))
    bench.tick()
    record = next(r for r in caplog.records if "raised in its update" in r.message)
    assert record.exc_info is not None


def test_the_fallback_takes_over_with_its_interfaces(bench: Any) -> None:
    bench.configure("spare", commands=ALL)
    bench.configure("bad", commands=ALL, fallback_names=("spare",)).fails_update = True
    bench.manager.switch_controller(SwitchRequest(("bad",)))
    bench.tick()
    assert bench.states() == {"bad": "inactive", "spare": "active"}


def test_whoever_holds_the_interfaces_of_a_fallback_is_deactivated(bench: Any) -> None:
    bench.configure("holder", commands=("j3/position",))
    bench.configure("spare", commands=("j0/position", "j3/position"))
    bad = bench.configure("bad", commands=("j0/position",), fallback_names=("spare",))
    bench.manager.switch_controller(SwitchRequest(("bad", "holder")))
    bad.fails_update = True
    bench.tick()
    assert bench.states() == {"bad": "inactive", "spare": "active", "holder": "inactive"}


def test_a_fallback_that_is_gone_is_logged_and_the_failed_one_still_stops(
    bench: Any, caplog: pytest.LogCaptureFixture
) -> None:
    bench.configure("spare", commands=ALL)
    bench.configure("bad", commands=ALL, fallback_names=("spare",)).fails_update = True
    bench.manager.switch_controller(SwitchRequest(("bad",)))
    bench.manager.unload_controller("spare")
    bench.tick()
    assert bench.states() == {"bad": "inactive"}
    assert "Could not activate controller with name 'spare'" in caplog.text


def test_a_controller_that_cannot_stop_is_cleaned_up_and_loses_its_interfaces(bench: Any) -> None:
    bench.configure("bad", commands=ALL).raises.add("deactivate")
    bench.configure("next", commands=ALL)
    bench.manager.switch_controller(SwitchRequest(("bad",)))
    result = bench.manager.switch_controller(SwitchRequest((), ("bad",)))
    assert not result.ok
    assert result.message.endswith("\nUnable to deactivate controllers: [ bad ]")
    assert bench.states()["bad"] == "unconfigured"
    assert bench.manager.switch_controller(SwitchRequest(("next",))).ok


# Hardware


def test_bring_up_activates_all_and_reads_once() -> None:
    hardware = fake_hardware(initial_positions={"j2": 0.7})
    manager = ControllerManager([hardware], 100)
    assert np.isnan(manager.resources.states).all()
    manager.bring_up()
    assert hardware.events == ["on_configure", "on_activate"]
    assert manager.resources.states.reshape(4, 3)[:, 0].tolist() == [0.0, 0.0, 0.7, 0.0]


def test_bring_up_leaves_components_where_told() -> None:
    names = ("A", "B", "C")
    hardware = [fake_hardware((f"{name}1",), name=name) for name in names]
    manager = ControllerManager(hardware, 100)
    manager.bring_up(unconfigured=["A"], inactive=["B"])
    assert [c.state.label for c in manager.list_hardware_components()] == [
        "unconfigured",
        "inactive",
        "active",
    ]


def test_bring_up_names_the_component_that_does_not_exist(bench: Any) -> None:
    with pytest.raises(ControllerManagerError, match="no hardware component 'X'; there is FakeSys"):
        bench.manager.bring_up(inactive=["X"])


def test_bring_up_says_which_step_failed() -> None:
    hardware = fake_hardware()
    hardware.refused.add("on_activate")
    with pytest.raises(ControllerManagerError, match="on_activate of hardware component 'FakeSys"):
        ControllerManager([hardware], 100).bring_up()


def test_the_update_rate_must_be_positive() -> None:
    with pytest.raises(ControllerManagerError, match="update_rate must be positive, not 0"):
        ControllerManager([], 0)


@pytest.mark.parametrize("result", ["read_result", "write_result"])
def test_hardware_that_fails_goes_down_with_its_users_only(
    result: str, caplog: pytest.LogCaptureFixture, bench: Any
) -> None:
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


def test_hardware_that_raises_counts_as_failed(bench: Any, caplog: Any) -> None:
    def broken(time_s: float, period_s: float) -> HardwareReturn:
        raise OSError("cable out")

    bench.hardware.read = broken
    bench.tick()
    (component,) = bench.manager.list_hardware_components()
    assert component.state is LifecycleState.UNCONFIGURED
    assert "cable out" in caplog.text


def test_hardware_that_failed_comes_back_with_its_interfaces(bench: Any) -> None:
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


def test_hardware_that_deactivates_itself_stops_only_who_commands_it(bench: Any) -> None:
    bench.configure("user", commands=ALL)
    bench.configure("watcher", states=("j1/velocity",))
    bench.manager.switch_controller(SwitchRequest(("user", "watcher")))
    bench.hardware.write_result = HardwareReturn.DEACTIVATE
    bench.tick()
    assert bench.states() == {"watcher": "active", "user": "inactive"}
    (component,) = bench.manager.list_hardware_components()
    assert component.state is LifecycleState.INACTIVE


def test_inactive_hardware_is_read_but_not_written(bench: Any) -> None:
    bench.configure("a", commands=ALL)
    bench.manager.switch_controller(SwitchRequest(("a",)))
    bench.manager.set_hardware_component_state("FakeSystem", LifecycleState.INACTIVE)
    bench.manager.resources.commands[:] = 1.0
    bench.tick()
    assert bench.states() == {"a": "active"}
    assert bench.manager.resources.states.reshape(4, 3)[:, 0].tolist() == [0.0] * 4


def test_cleaning_hardware_up_stops_its_users(bench: Any) -> None:
    bench.configure("a", commands=ALL)
    bench.manager.switch_controller(SwitchRequest(("a",)))
    bench.manager.set_hardware_component_state("FakeSystem", LifecycleState.UNCONFIGURED)
    assert bench.states() == {"a": "inactive"}
    commands, states = bench.manager.list_hardware_interfaces()
    assert not any(i.is_available for i in (*commands, *states))


def test_finalized_hardware_stays_so(bench: Any) -> None:
    bench.manager.set_hardware_component_state("FakeSystem", LifecycleState.FINALIZED)
    with pytest.raises(ControllerManagerError, match="is finalized"):
        bench.manager.set_hardware_component_state("FakeSystem", LifecycleState.ACTIVE)


def test_two_components_of_one_name_are_refused() -> None:
    with pytest.raises(ControllerManagerError, match="two hardware components are named 'Fake"):
        ControllerManager([fake_hardware(), fake_hardware(("k0",))], 100)


def test_two_components_with_the_same_interface_are_refused() -> None:
    with pytest.raises(ControllerManagerError, match=r"'j0/position' belongs to .*'FakeSystem'"):
        ControllerManager([fake_hardware(), fake_hardware(("j0",), name="B")], 100)


def test_the_log_is_silent_while_all_is_well(bench: Any, caplog: Any) -> None:
    bench.configure("a", commands=ALL)
    bench.manager.switch_controller(SwitchRequest(("a",)))
    with caplog.at_level(logging.DEBUG):
        caplog.clear()
        bench.tick(100)
    assert caplog.text == ""
