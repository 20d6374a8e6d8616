"""The decision table of switch_controller: strictness, order, messages, claims."""

import pytest

from arm_control import (
    Controller,
    ControllerContext,
    ControllerManagerError,
    InterfaceConfiguration,
    LifecycleState,
    NoParameters,
    ReturnType,
    Strictness,
    SwitchRequest,
)
from arm_control.manager.controller_switcher import NOTHING_TO_SWITCH, PREPARE_REJECTED

BEST_EFFORT, STRICT = Strictness.BEST_EFFORT, Strictness.STRICT
SOFT = (Strictness.BEST_EFFORT, Strictness.AUTO, Strictness.FORCE_AUTO)


def unknown(action: str, name: str = "nothere") -> str:
    return (
        f"Could not {action} controller with name '{name}' "
        "because no controller with this name exists"
    )


# The table EmptyListOrNonExistentTest: (activate, deactivate) -> ok, with 'on' active, 'off' not.
TABLE = [
    ((), (), True, True),
    ((), ("nothere",), False, False),
    (("nothere",), (), False, False),
    (("nothere",), ("nothere",), False, False),
    ((), ("on", "nothere"), False, True),
    ((), ("nothere", "on"), False, True),
    (("off", "nothere"), (), False, True),
    (("nothere", "off"), (), False, True),
    (("off", "nothere"), ("on", "nothere"), False, True),
    (("off",), ("nothere",), False, False),
    (("nothere",), ("on",), False, False),
    (("off",), ("on",), True, True),
]


@pytest.mark.parametrize(("activate", "deactivate", "strict_ok", "soft_ok"), TABLE)
@pytest.mark.parametrize("strictness", Strictness)
def test_empty_and_unknown_names(bench, activate, deactivate, strict_ok, soft_ok, strictness):
    bench.configure("on")
    bench.configure("off")
    bench.manager.switch_controller(SwitchRequest(("on",)))
    result = bench.manager.switch_controller(SwitchRequest(activate, deactivate, strictness))
    assert result.ok is (strict_ok if strictness is STRICT else soft_ok)
    if not result.ok:
        assert bench.states() == {"off": "inactive", "on": "active"}


def test_a_strict_switch_names_the_first_unknown_controller(bench):
    bench.configure("a")
    result = bench.manager.switch_controller(SwitchRequest(("a", "x", "y"), (), STRICT))
    assert result.message == unknown("activate", "x")
    assert bench.states() == {"a": "inactive"}


def test_unknown_names_to_deactivate_come_first(bench):
    result = bench.manager.switch_controller(SwitchRequest(("x",), ("y",), STRICT))
    assert result.message == unknown("deactivate", "y")


def test_a_soft_switch_of_only_unknown_names_lists_each_on_a_line(bench):
    result = bench.manager.switch_controller(SwitchRequest(("x", "y")))
    assert result.message == f"{unknown('activate', 'x')}\n{unknown('activate', 'y')}\n"


def test_the_log_says_which_controllers_there_are(bench, caplog):
    bench.configure("a")
    bench.manager.switch_controller(SwitchRequest(("x",), (), STRICT))
    assert "(loaded: a)" in caplog.text


def test_a_repeated_name_is_used_once(bench):
    bench.configure("a", commands=("j0/position",))
    assert bench.manager.switch_controller(SwitchRequest(("a", "a"), (), STRICT)).ok


# Candidates


def test_an_unconfigured_controller_is_not_activated(bench):
    bench.load("raw")
    bench.configure("a")
    strict = bench.manager.switch_controller(SwitchRequest(("raw", "a"), (), STRICT))
    assert (strict.ok, bench.states()["a"]) == (False, "inactive")
    assert "'raw' can not be activated since it is unconfigured" in strict.message
    soft = bench.manager.switch_controller(SwitchRequest(("raw", "a")))
    assert (soft.ok, bench.states()) == (True, {"a": "active", "raw": "unconfigured"})


def test_an_active_controller_is_not_activated_again(bench):
    bench.configure("a")
    bench.manager.switch_controller(SwitchRequest(("a",)))
    strict = bench.manager.switch_controller(SwitchRequest(("a",), (), STRICT))
    soft = bench.manager.switch_controller(SwitchRequest(("a",)))
    assert strict.message == "Controller with name 'a' is already active."
    assert (soft.ok, soft.message) == (True, NOTHING_TO_SWITCH)


def test_an_inactive_controller_is_not_deactivated(bench):
    bench.configure("a")
    strict = bench.manager.switch_controller(SwitchRequest((), ("a",), STRICT))
    soft = bench.manager.switch_controller(SwitchRequest((), ("a",)))
    assert (
        strict.message == "Controller with name 'a' can not be deactivated since it is not active."
    )
    assert (soft.ok, soft.message) == (True, NOTHING_TO_SWITCH)


def test_a_refused_activation_is_reported_before_a_refused_deactivation(bench):
    bench.load("raw")
    bench.configure("a")
    result = bench.manager.switch_controller(SwitchRequest(("raw",), ("a",), STRICT))
    assert "'raw' can not be activated" in result.message


def test_a_controller_in_both_lists_is_restarted(bench):
    bench.configure("a", commands=("j0/position",))
    bench.manager.switch_controller(SwitchRequest(("a",)))
    bench.events.clear()
    assert bench.manager.switch_controller(SwitchRequest(("a",), ("a",), STRICT)).ok
    assert bench.events == ["a deactivate", "a activate"]
    assert bench.hardware.mode_switches[-1] == (("j0/position",), ("j0/position",))


def test_an_inactive_controller_in_both_lists(bench):
    bench.configure("a")
    strict = bench.manager.switch_controller(SwitchRequest(("a",), ("a",), STRICT))
    assert (strict.ok, bench.states()) == (False, {"a": "inactive"})
    soft = bench.manager.switch_controller(SwitchRequest(("a",), ("a",)))
    assert (soft.ok, bench.states()) == (True, {"a": "active"})


@pytest.mark.parametrize("spare", ["missing", "unconfigured", "lacks an interface"])
def test_fallbacks_must_be_ready_before_the_controller_starts(bench, spare):
    if spare == "unconfigured":
        bench.load("spare")
    elif spare != "missing":
        bench.configure("spare", commands=("j9/position",))
    bench.configure("a", fallback_names=("spare",))
    result = bench.manager.switch_controller(SwitchRequest(("a",), (), STRICT))
    assert not result.ok
    assert "its fallback controller 'spare'" in result.message


# Interfaces


def refusal(name: str, trouble: str) -> str:
    return f"Unable to activate controller '{name}' since the {trouble}"


@pytest.mark.parametrize("strictness", Strictness)
def test_a_missing_command_interface(bench, strictness, caplog):
    bench.configure("bad", commands=("j9/position",))
    bench.configure("good", commands=("j0/position",))
    result = bench.manager.switch_controller(SwitchRequest(("good", "bad"), (), strictness))
    assert not result.ok
    assert result.message == refusal("bad", "command interface 'j9/position' is not available.")
    assert bench.states() == {"good": "inactive", "bad": "inactive"}
    assert "(available: j0/position, j1/position, j2/position, j3/position)" in caplog.text


@pytest.mark.parametrize("strictness", Strictness)
def test_a_missing_state_interface(bench, strictness):
    bench.configure("bad", states=("j0/torque",))
    result = bench.manager.switch_controller(SwitchRequest(("bad",), (), strictness))
    assert result.message == refusal("bad", "state interface 'j0/torque' is not available.")


@pytest.mark.parametrize("strictness", Strictness)
def test_a_claimed_interface(bench, strictness, caplog):
    bench.configure("holder", commands=("j0/position",))
    bench.configure("next", commands=("j0/position",))
    bench.manager.switch_controller(SwitchRequest(("holder",)))
    result = bench.manager.switch_controller(SwitchRequest(("next",), (), strictness))
    assert result.message == refusal(
        "next", "command interface 'j0/position' is currently claimed by another controller."
    )
    assert "(by 'holder')" in caplog.text


@pytest.mark.parametrize("strictness", Strictness)
def test_two_controllers_of_one_request_that_want_the_same(bench, strictness):
    bench.configure("a", commands=("j0/position",))
    bench.configure("b", commands=("j0/position",))
    result = bench.manager.switch_controller(SwitchRequest(("a", "b"), (), strictness))
    assert result.message == refusal(
        "b",
        "command interface 'j0/position' will be used by another controller "
        "that is being activated.",
    )
    assert bench.states() == {"a": "inactive", "b": "inactive"}


def test_a_controller_of_all_commands_leaves_none_to_another(bench):
    class Greedy(Controller[NoParameters]):
        def command_interface_configuration(self) -> InterfaceConfiguration:
            return InterfaceConfiguration.all()

        def state_interface_configuration(self) -> InterfaceConfiguration:
            return InterfaceConfiguration.none()

        def on_configure(self, parameters: NoParameters) -> None:
            pass

        def update(self, time_s: float, period_s: float) -> ReturnType:
            return ReturnType.OK

    bench.manager.load_controller(Greedy(ControllerContext("greedy", 100)), "test/Greedy")
    bench.manager.configure_controller("greedy", NoParameters())
    bench.configure("modest", commands=("j2/position",))
    assert bench.manager.switch_controller(SwitchRequest(("greedy",))).ok
    result = bench.manager.switch_controller(SwitchRequest(("modest",)))
    assert "'j2/position' is currently claimed by another controller." in result.message
    assert bench.manager.switch_controller(SwitchRequest(("modest",), ("greedy",))).ok


def test_a_finalized_controller_is_not_activated(bench):
    bench.configure("a")
    bench.manager.shutdown()
    result = bench.manager.switch_controller(SwitchRequest(("a",), (), STRICT))
    assert (result.ok, bench.states()) == (False, {"a": "finalized"})
    with pytest.raises(ControllerManagerError, match="can not be configured from 'finalized'"):
        bench.manager.configure_controller("a", None)


def test_controllers_change_places_as_groups(bench):
    for name, joint in (("a", "j0"), ("b", "j1"), ("c", "j0"), ("d", "j1")):
        bench.configure(name, commands=(f"{joint}/position",))
    bench.manager.switch_controller(SwitchRequest(("a", "b"), (), STRICT))
    result = bench.manager.switch_controller(SwitchRequest(("c", "d"), ("a", "b"), STRICT))
    assert result.ok
    assert bench.states() == {"d": "active", "c": "active", "b": "inactive", "a": "inactive"}


def test_interfaces_released_by_the_same_request_are_free(bench):
    bench.configure("old", commands=("j0/position",))
    bench.configure("new", commands=("j0/position",))
    bench.manager.switch_controller(SwitchRequest(("old",)))
    assert bench.manager.switch_controller(SwitchRequest(("new",), ("old",), STRICT)).ok
    assert bench.states() == {"new": "active", "old": "inactive"}


def test_state_interfaces_are_shared(bench):
    bench.configure("a", states=("j0/position",))
    bench.configure("b", states=("j0/position",))
    assert bench.manager.switch_controller(SwitchRequest(("a", "b"), (), STRICT)).ok


# Hardware's word


def test_hardware_may_refuse(bench):
    bench.configure("a", commands=("j0/position",))
    bench.hardware.refused.add("prepare_command_mode_switch")
    result = bench.manager.switch_controller(SwitchRequest(("a",)))
    assert (result.ok, result.message) == (False, PREPARE_REJECTED)
    assert bench.states() == {"a": "inactive"}


def test_inactive_hardware_accepts_no_commands(bench, caplog):
    bench.configure("a", commands=("j0/position",))
    bench.configure("watcher", states=("j0/position",))
    bench.manager.set_hardware_component_state("FakeSystem", LifecycleState.INACTIVE)
    assert bench.manager.switch_controller(SwitchRequest(("a",))).message == PREPARE_REJECTED
    assert "'FakeSystem' is inactive" in caplog.text
    assert bench.manager.switch_controller(SwitchRequest(("watcher",))).ok


def test_a_mode_switch_that_fails_switches_nothing(bench):
    bench.configure("old", commands=("j0/position",))
    bench.configure("new", commands=("j0/position",))
    bench.manager.switch_controller(SwitchRequest(("old",)))
    bench.hardware.refused.add("perform_command_mode_switch")
    result = bench.manager.switch_controller(SwitchRequest(("new",), ("old",), STRICT))
    assert result.message == (
        "Failed switching controllers.... \n"
        "Unable to activate controllers: [ new ]\n"
        "Unable to deactivate controllers: [ old ]"
    )
    assert bench.states() == {"new": "inactive", "old": "active"}


def test_hardware_gets_only_its_own_interfaces(bench):
    bench.configure("a", commands=("j1/position", "j0/position"))
    bench.manager.switch_controller(SwitchRequest(("a",)))
    bench.manager.switch_controller(SwitchRequest((), ("a",)))
    assert bench.hardware.mode_switches == [
        (("j1/position", "j0/position"), ()),
        ((), ("j1/position", "j0/position")),
    ]


# Execution


def test_all_are_deactivated_before_any_is_activated(bench):
    for name in ("a", "b"):
        bench.configure(f"old_{name}")
        bench.configure(f"new_{name}")
    bench.manager.switch_controller(SwitchRequest(("old_a", "old_b")))
    bench.events.clear()
    bench.manager.switch_controller(SwitchRequest(("new_a", "new_b"), ("old_a", "old_b")))
    assert bench.events == [
        "old_a deactivate",
        "old_b deactivate",
        "new_a activate",
        "new_b activate",
    ]


@pytest.mark.parametrize("way", ["refuses", "raises"])
def test_a_strict_switch_is_undone_when_one_activation_fails(bench, way):
    bench.configure("good", commands=("j0/position",))
    getattr(bench.configure("bad", commands=("j1/position",)), way).add("activate")
    result = bench.manager.switch_controller(SwitchRequest(("good", "bad"), (), STRICT))
    assert result.message == (
        "Failed switching controllers.... \nUnable to activate controllers: [ bad ]"
    )
    assert bench.states() == {"bad": "inactive", "good": "inactive"}


def test_a_best_effort_switch_keeps_the_activated_controllers(bench):
    bench.configure("good", commands=("j0/position",))
    bench.configure("bad", commands=("j1/position",)).refuses.add("activate")
    result = bench.manager.switch_controller(SwitchRequest(("good", "bad")))
    assert not result.ok
    assert bench.states() == {"bad": "inactive", "good": "active"}


def test_a_failed_activation_frees_interfaces_and_modes(bench):
    bench.configure("bad", commands=("j1/position",)).refuses.add("activate")
    bench.configure("next", commands=("j1/position",))
    bench.manager.switch_controller(SwitchRequest(("bad",)))
    assert bench.hardware.mode_switches[-1] == ((), ("j1/position",))
    assert bench.manager.switch_controller(SwitchRequest(("next",))).ok


def test_messages_of_success(bench):
    for name in ("a", "b", "c"):
        bench.configure(name)
    switch = bench.manager.switch_controller
    assert switch(SwitchRequest(("a", "b"))).message == (
        "Successfully switched controllers!\nActivated controllers: [ a b ]"
    )
    assert switch(SwitchRequest(("c",), ("a",))).message == (
        "Successfully switched controllers!\n"
        "Deactivated controllers: [ a ]\n"
        "Activated controllers: [ c ]"
    )
    assert switch(SwitchRequest(("a",), ("c",), STRICT)).message == (
        "Successfully switched controllers!"
    )
