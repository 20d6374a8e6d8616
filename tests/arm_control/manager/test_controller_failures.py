"""What happens when a controller fails."""

import pytest

from arm_control import ControllerManager, SwitchRequest
from arm_control.manager.switch_planner import Strictness
from arm_control.testing import fake_hardware

ALL = ("j0/position", "j1/position", "j2/position", "j3/position")


@pytest.mark.parametrize("how", ["returns ERROR", "raises"])
@pytest.mark.parametrize("commands", [ALL, ()])
def test_a_controller_whose_update_fails_is_deactivated(bench, how, commands, caplog):
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
    assert "activate again with: arm control switch_controllers --activate bad" in caplog.text


def test_the_suggested_command_names_a_manager_with_another_name(bench, caplog):
    bench.manager = ControllerManager([fake_hardware()], 100, name="/left/controller_manager")
    bench.configure("bad").fails_update = True
    bench.manager.switch_controller(SwitchRequest(("bad",)))
    bench.tick()
    assert (
        "activate again with: arm control switch_controllers --activate bad "
        "-c /left/controller_manager"
    ) in caplog.text


def test_a_failed_controller_gives_its_interfaces_back(bench):
    bench.configure("bad", commands=ALL).fails_update = True
    bench.configure("next", commands=ALL)
    bench.manager.switch_controller(SwitchRequest(("bad",)))
    bench.tick()
    assert bench.hardware.mode_switches[-1] == ((), ALL)
    assert bench.manager.switch_controller(SwitchRequest(("next",))).ok


def test_a_failed_controller_can_be_activated_again(bench):
    probe = bench.configure("bad", commands=ALL)
    probe.fails_update = True
    bench.manager.switch_controller(SwitchRequest(("bad",)))
    bench.tick()
    probe.fails_update = False
    assert bench.manager.switch_controller(SwitchRequest(("bad",))).ok
    bench.tick()
    assert bench.states() == {"bad": "active"}


def test_a_controller_that_raises_leaves_its_traceback(bench, caplog):
    bench.configure("bad", commands=ALL).raises.add("update")
    bench.manager.switch_controller(SwitchRequest(("bad",)))
    bench.tick()
    record = next(r for r in caplog.records if "raised in its update" in r.message)
    assert record.exc_info is not None


def test_the_fallback_takes_over_with_its_interfaces(bench):
    bench.configure("spare", commands=ALL)
    bench.configure("bad", commands=ALL, fallback_names=("spare",)).fails_update = True
    bench.manager.switch_controller(SwitchRequest(("bad",)))
    bench.tick()
    assert bench.states() == {"bad": "inactive", "spare": "active"}


def test_controllers_that_claim_the_interfaces_of_a_fallback_are_deactivated(bench):
    bench.configure("holder", commands=("j3/position",))
    bench.configure("spare", commands=("j0/position", "j3/position"))
    bad = bench.configure("bad", commands=("j0/position",), fallback_names=("spare",))
    bench.manager.switch_controller(SwitchRequest(("bad", "holder")))
    bad.fails_update = True
    bench.tick()
    assert bench.states() == {"bad": "inactive", "spare": "active", "holder": "inactive"}


def test_a_fallback_that_is_gone_is_logged_and_the_failed_one_still_stops(bench, caplog):
    bench.configure("spare", commands=ALL)
    bench.configure("bad", commands=ALL, fallback_names=("spare",)).fails_update = True
    bench.manager.switch_controller(SwitchRequest(("bad",)))
    bench.manager.unload_controller("spare")
    bench.tick()
    assert bench.states() == {"bad": "inactive"}
    assert "Could not activate controller with name 'spare'" in caplog.text


def test_a_controller_that_cannot_stop_is_cleaned_up_and_loses_its_interfaces(bench):
    bench.configure("bad", commands=ALL).raises.add("deactivate")
    bench.configure("next", commands=ALL)
    bench.manager.switch_controller(SwitchRequest(("bad",)))
    result = bench.manager.switch_controller(SwitchRequest((), ("bad",)))
    assert not result.ok
    assert result.message.endswith("\nUnable to deactivate controllers: [ bad ]")
    assert bench.states()["bad"] == "unconfigured"
    assert bench.manager.switch_controller(SwitchRequest(("next",))).ok


@pytest.mark.parametrize("strictness", [Strictness.STRICT, Strictness.BEST_EFFORT])
def test_a_controller_that_cannot_stop_is_not_restarted(bench, strictness):
    bench.configure("bad", commands=ALL).refuses.add("deactivate")
    bench.configure("good", states=("j0/position",))
    bench.manager.switch_controller(SwitchRequest(("bad",)))
    result = bench.manager.switch_controller(SwitchRequest(("bad", "good"), ("bad",), strictness))
    assert not result.ok
    assert "Unable to activate controllers: [ bad ]" in result.message
    assert bench.states() == {
        "bad": "unconfigured",
        "good": "inactive" if strictness is Strictness.STRICT else "active",
    }
    assert bench.events.count("bad activate") == 1
    assert bench.hardware.mode_switches[-1] == ((), ALL)
