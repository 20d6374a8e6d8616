"""Life cycle, the clients' view, and the order of a tick."""

import logging
from typing import Any

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
from arm_control.controllers.forward_command.controller import (
    JointGroupPositionController,
    PositionGroupParameters,
)
from arm_control.manager.switch_planner import Strictness
from arm_control.testing import fake_hardware

ALL = ("j0/position", "j1/position", "j2/position", "j3/position")


# Loading and the life cycle


def test_a_loaded_controller_is_unconfigured(bench):
    bench.load("a")
    assert bench.states() == {"a": "unconfigured"}


def test_the_newest_controller_is_listed_first(bench):
    bench.load("a")
    bench.load("b")
    assert list(bench.states()) == ["b", "a"]


def test_a_name_is_loaded_only_once(bench):
    bench.load("a")
    with pytest.raises(ControllerManagerError, match="'a' was already loaded"):
        bench.load("a")


def test_a_controller_cannot_be_its_own_fallback(bench):
    with pytest.raises(ControllerManagerError, match="own fallback"):
        bench.load("a", fallback_names=("a",))


def test_configure_makes_it_inactive(bench):
    bench.configure("a")
    assert bench.states() == {"a": "inactive"}


def test_configure_of_an_unknown_name_says_what_is_loaded(bench):
    bench.load("a")
    with pytest.raises(ControllerManagerError, match=r"no controller with this name.*loaded: a"):
        bench.manager.configure_controller("b", None)


def test_an_inactive_controller_is_cleaned_up_before_it_is_configured_again(bench):
    probe = bench.configure("a")
    bench.manager.configure_controller("a", probe.parameters_type())
    assert bench.events == ["a configure", "a cleanup", "a configure"]


def test_an_active_controller_is_not_configured(bench):
    probe = bench.configure("a")
    bench.manager.switch_controller(SwitchRequest(("a",)))
    with pytest.raises(ControllerManagerError, match="can not be configured from 'active' state"):
        bench.manager.configure_controller("a", probe.parameters_type())


@pytest.mark.parametrize("way", ["refuses", "raises"])
def test_a_failing_configure_leaves_it_unconfigured_with_its_reason(bench, way):
    probe = bench.load("a")
    getattr(probe, way).add("configure")
    with pytest.raises(ControllerManagerError, match=r"does not want to|broke in configure"):
        bench.manager.configure_controller("a", probe.parameters_type())
    assert bench.states() == {"a": "unconfigured"}


@pytest.mark.parametrize("kind", ["commands", "states"])
def test_an_interface_requested_twice_fails_the_configuration(bench, kind):
    with pytest.raises(ControllerManagerError, match=r"interface j0/position more than once"):
        bench.configure("a", **{kind: ("j0/position", "j1/position", "j0/position")})
    assert bench.states() == {"a": "unconfigured"}


def test_cleanup_takes_an_inactive_controller_back(bench):
    bench.configure("a", commands=ALL)
    bench.manager.cleanup_controller("a")
    (status,) = bench.manager.list_controllers()
    assert (status.state, status.required_command_interfaces) == (LifecycleState.UNCONFIGURED, ())


def test_cleanup_of_an_unconfigured_controller_does_nothing(bench):
    bench.load("a")
    bench.manager.cleanup_controller("a")
    assert bench.events == []


def test_cleanup_of_an_unknown_name_says_what_is_loaded(bench):
    bench.load("a")
    with pytest.raises(ControllerManagerError, match=r"clean up controller with name 'x'.*: a"):
        bench.manager.cleanup_controller("x")


@pytest.mark.parametrize("way", ["refuses", "raises"])
def test_a_controller_that_cannot_be_cleaned_up_stays_inactive(bench, way):
    probe = bench.configure("a", commands=ALL)
    getattr(probe, way).add("cleanup")
    with pytest.raises(ControllerManagerError, match="controller 'a' was not cleaned up: "):
        bench.manager.cleanup_controller("a")
    with pytest.raises(ControllerManagerError, match="controller 'a' was not cleaned up: "):
        bench.manager.configure_controller("a", type(probe).parameters_type())
    assert bench.states() == {"a": "inactive"}
    # It can still be used, and taken out.
    assert bench.manager.switch_controller(SwitchRequest(("a",))).ok
    assert bench.manager.switch_controller(SwitchRequest((), ("a",))).ok
    bench.manager.unload_controller("a")
    assert bench.states() == {}


def test_a_controller_can_be_configured_again_after_cleanup(bench):
    probe = bench.configure("a", commands=ALL[:1])
    bench.manager.cleanup_controller("a")
    bench.manager.configure_controller("a", type(probe).parameters_type(ALL[1:2]))
    (status,) = bench.manager.list_controllers()
    assert status.required_command_interfaces == ALL[1:2]


def test_an_active_controller_is_not_cleaned_up(bench):
    bench.configure("a")
    bench.manager.switch_controller(SwitchRequest(("a",)))
    with pytest.raises(ControllerManagerError, match="cleaned-up from 'active'"):
        bench.manager.cleanup_controller("a")


def test_a_finalized_controller_is_not_cleaned_up(bench):
    bench.configure("a")
    bench.manager.shutdown()
    with pytest.raises(ControllerManagerError, match="cleaned-up from 'finalized'"):
        bench.manager.cleanup_controller("a")


def test_unload_cleans_up_shuts_down_and_forgets(bench):
    bench.configure("a")
    bench.manager.unload_controller("a")
    assert bench.events == ["a configure", "a cleanup", "a shutdown"]
    assert bench.states() == {}


def test_an_active_controller_is_not_unloaded(bench):
    bench.configure("a")
    bench.manager.switch_controller(SwitchRequest(("a",)))
    with pytest.raises(ControllerManagerError, match="still active"):
        bench.manager.unload_controller("a")


def test_the_same_name_can_be_loaded_again_after_unload(bench):
    bench.configure("a")
    bench.manager.unload_controller("a")
    bench.load("a")
    assert bench.states() == {"a": "unconfigured"}


def test_shutdown_finalizes_controllers_then_hardware(bench):
    bench.configure("a", commands=ALL)
    bench.manager.switch_controller(SwitchRequest(("a",)))
    bench.events.clear()
    bench.manager.shutdown()
    assert bench.events == ["a deactivate", "a cleanup", "a shutdown"]
    assert bench.hardware.events[-1] == "on_shutdown"
    (component,) = bench.manager.list_hardware_components()
    assert component.state is LifecycleState.FINALIZED


# What clients see


def test_interfaces_are_required_when_configured_and_claimed_when_active(bench):
    bench.configure("a", commands=ALL, states=("j0/velocity",))
    (inactive,) = bench.manager.list_controllers()
    bench.manager.switch_controller(SwitchRequest(("a",)))
    (active,) = bench.manager.list_controllers()
    assert inactive.required_command_interfaces == active.required_command_interfaces == ALL
    assert inactive.required_state_interfaces == ("j0/velocity",)
    assert (inactive.claimed_interfaces, active.claimed_interfaces) == ((), ALL)


def test_hardware_interfaces_are_sorted_and_show_claims(bench):
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


def test_components_are_listed_with_plugin_type_state_and_rate(bench):
    (component,) = bench.manager.list_hardware_components()
    assert (component.name, component.type) == ("FakeSystem", "system")
    assert component.plugin == "mock_components/GenericSystem"
    assert component.state is LifecycleState.ACTIVE
    assert component.read_write_rate_hz == 100


def test_every_transition_is_reported(bench, observer):
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


def test_a_transition_that_fails_is_reported_as_going_nowhere(bench, observer):
    bench.configure("a").refuses.add("activate")
    bench.manager.switch_controller(SwitchRequest(("a",)))
    s = LifecycleState
    assert observer.transitions[-1] == ("a", "activate", s.INACTIVE, s.INACTIVE)


def test_one_activity_per_change_of_controllers(bench, observer):
    bench.configure("a")
    before = observer.changes
    bench.manager.switch_controller(SwitchRequest(("a",)))
    assert observer.changes == before + 1


@pytest.mark.parametrize(
    "request_",
    [
        SwitchRequest(("nobody",), (), Strictness.STRICT),
        SwitchRequest(("broken",), (), Strictness.STRICT),
        SwitchRequest((), ("a",)),
        SwitchRequest(),
    ],
    ids=["unknown", "refuses", "inactive", "nothing"],
)
def test_a_switch_that_changes_nothing_reports_nothing(bench, observer, request_):
    bench.configure("a")
    bench.configure("broken").refuses.add("activate")
    before = observer.changes
    bench.manager.switch_controller(request_)
    assert observer.changes == before


def test_a_restart_is_reported(bench, observer):
    bench.configure("a")
    bench.manager.switch_controller(SwitchRequest(("a",)))
    before = observer.changes
    assert bench.manager.switch_controller(SwitchRequest(("a",), ("a",))).ok
    assert observer.changes == before + 1


def test_hardware_that_stays_as_it_is_reports_nothing(bench, observer):
    (component,) = bench.manager.list_hardware_components()
    bench.manager.set_hardware_component_state(component.name, component.state)
    with pytest.raises(ControllerManagerError):
        bench.manager.set_hardware_component_state("nothing", LifecycleState.INACTIVE)
    assert observer.changes == 0
    bench.manager.set_hardware_component_state(component.name, LifecycleState.INACTIVE)
    assert observer.changes == 1


class CountedName(str):
    """A name that counts how often it is compared with another one."""

    comparisons = 0
    __hash__ = str.__hash__

    def __eq__(self, other: object) -> bool:
        CountedName.comparisons += 1
        return str.__eq__(self, other)


def test_a_switch_does_not_compare_each_interface_with_each_other(bench):
    joints = [f"joint{i}" for i in range(300)]
    manager = ControllerManager([fake_hardware(joints)], 100)
    manager.bring_up()
    bench.manager = manager
    states = tuple(CountedName(f"{joint}/position") for joint in joints)
    bench.configure("many", states=states)
    bench.configure("one", states=states[:1])
    CountedName.comparisons = 0
    assert manager.switch_controller(SwitchRequest(("one",))).ok
    assert CountedName.comparisons < 10 * len(states)


def test_a_tick_without_changes_reports_nothing(bench, observer):
    bench.configure("a", commands=ALL)
    bench.manager.switch_controller(SwitchRequest(("a",)))
    before = observer.changes
    bench.tick(10)
    assert observer.changes == before


# One tick


class PositionReader(Controller[Any]):
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


def test_a_command_is_visible_in_the_very_next_publish(bench, make):
    reader = make(PositionReader, None)
    position = JointGroupPositionController(reader.context)
    position.name = "position"
    bench.manager.load_controller(position, "position_controllers/JointGroupPositionController")
    bench.manager.configure_controller("position", PositionGroupParameters(joints=("j0",)))
    bench.manager.switch_controller(SwitchRequest(("it", "position")))
    bench.tick()
    position.offer([0.5])
    bench.tick()
    assert reader.published == [0.0, 0.5]


def test_commanding_controllers_run_in_update_and_others_in_publish(bench):
    bench.configure("commands", commands=ALL)
    bench.configure("watches", states=("j0/position",))
    bench.manager.switch_controller(SwitchRequest(("commands", "watches")))
    bench.events.clear()
    bench.manager.update(0.0, 0.01)
    assert bench.events == ["commands update"]
    bench.manager.publish(0.01, 0.01)
    assert bench.events == ["commands update", "watches update"]


def test_update_gets_time_and_period(bench):
    probe = bench.configure("a", commands=ALL)
    bench.manager.switch_controller(SwitchRequest(("a",)))
    bench.tick(2)
    assert probe.updates == [(0.0, 0.01), (0.01, 0.01)]


def test_an_inactive_controller_is_not_updated(bench):
    probe = bench.configure("a", commands=ALL)
    bench.tick()
    assert probe.updates == []


def test_states_are_read_only_for_controllers(bench):
    probe = bench.configure("a", states=("j0/position", "j1/position"))
    bench.manager.switch_controller(SwitchRequest(("a",)))
    with pytest.raises(ValueError, match="read-only"):
        probe.states.read()[0] = 1.0


def test_the_log_is_silent_while_all_is_well(bench, caplog):
    bench.configure("a", commands=ALL)
    bench.manager.switch_controller(SwitchRequest(("a",)))
    with caplog.at_level(logging.DEBUG):
        caplog.clear()
        bench.tick(100)
    assert caplog.text == ""
