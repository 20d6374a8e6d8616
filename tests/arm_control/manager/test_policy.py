"""The manager's behaviour for each policy parameter."""

from typing import Any

import pytest

from arm_control import (
    ControllerManager,
    ControllerManagerError,
    LifecycleState,
    ManagerPolicy,
    SwitchRequest,
)
from arm_control.errors import UnhandledFailureError
from arm_control.hardware.driver import HardwareReturn
from arm_control.testing import fake_hardware

ALL = ("j0/position", "j1/position", "j2/position", "j3/position")


def govern(bench: Any, **choices: bool) -> None:
    """Give the bench a manager with these choices."""
    bench.hardware = fake_hardware()
    bench.manager = ControllerManager([bench.hardware], 100, ManagerPolicy(**choices))


@pytest.mark.parametrize("commands", [ALL, ()])
def test_without_handling_a_controller_that_raises_ends_the_tick(bench, commands):
    govern(bench, handle_exceptions=False)
    bench.manager.bring_up()
    bench.configure("bad", commands=commands).raises.add("update")
    bench.manager.switch_controller(SwitchRequest(("bad",)))
    with pytest.raises(
        UnhandledFailureError,
        match=r"'bad' raised in its update: RuntimeError: bad broke in update; .*handle_exceptions",
    ):
        bench.tick()


@pytest.mark.parametrize("exchange", ["read", "write"])
def test_without_handling_hardware_that_raises_ends_the_tick(bench, exchange):
    govern(bench, handle_exceptions=False)
    bench.manager.bring_up()

    def broken(time_s: float, period_s: float) -> HardwareReturn:
        raise OSError("cable out")

    setattr(bench.hardware, exchange, broken)
    with pytest.raises(UnhandledFailureError, match="'FakeSystem' failed: OSError: cable out"):
        bench.tick()


def test_without_handling_a_returned_error_still_stops_only_the_controller(bench):
    govern(bench, handle_exceptions=False)
    bench.manager.bring_up()
    bench.configure("bad", commands=ALL).fails_update = True
    bench.manager.switch_controller(SwitchRequest(("bad",)))
    bench.tick()
    assert bench.states() == {"bad": "inactive"}


@pytest.mark.parametrize("allowed", [False, True])
def test_inactive_hardware_can_be_claimed_where_allowed(bench, allowed):
    govern(bench, activate_with_inactive_hardware=allowed)
    bench.manager.bring_up(inactive=["FakeSystem"])
    bench.configure("a", commands=ALL)
    assert bench.manager.switch_controller(SwitchRequest(("a",))).ok is allowed


def test_unconfigured_hardware_cannot_be_claimed_in_any_case(bench):
    govern(bench, activate_with_inactive_hardware=True)
    bench.manager.bring_up(unconfigured=["FakeSystem"])
    bench.configure("a", commands=ALL)
    result = bench.manager.switch_controller(SwitchRequest(("a",)))
    assert "'j0/position' is not available" in result.message


def test_controllers_can_outlive_hardware_that_deactivates_itself(bench):
    govern(bench, stop_with_self_deactivated_hardware=False)
    bench.manager.bring_up()
    bench.configure("user", commands=ALL)
    bench.manager.switch_controller(SwitchRequest(("user",)))
    bench.hardware.write_result = HardwareReturn.DEACTIVATE
    bench.tick(2)
    assert bench.states() == {"user": "active"}
    (component,) = bench.manager.list_hardware_components()
    assert component.state is LifecycleState.INACTIVE


def test_hardware_that_does_not_come_up_can_be_let_pass(bench, caplog):
    good, bad = fake_hardware(), fake_hardware(("k0",), name="Bad")
    bad.refused.add("on_activate")
    manager = ControllerManager([bad, good], 100, ManagerPolicy(end_on_initial_state_failure=False))
    manager.bring_up()
    states = {c.name: c.state.label for c in manager.list_hardware_components()}
    assert states == {"Bad": "inactive", "FakeSystem": "active"}
    assert "on_activate of hardware component 'Bad'" in caplog.text
    with pytest.raises(ControllerManagerError, match="on_activate of hardware component 'Bad'"):
        ControllerManager([bad], 100).bring_up()
