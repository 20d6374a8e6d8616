"""Active controllers whose hardware is not active: what is called, commanded, and refused."""

import math

import numpy as np
import pytest

from arm_control import ControllerManager, JointLimits, SwitchRequest
from arm_control.lifecycle import LifecycleState
from arm_control.manager.controller_switcher import PREPARE_REJECTED
from arm_control.manager.settings import ManagerPolicy
from arm_control.testing import FakeHardware, fake_hardware

POSITIONS = ("j0/position", "j1/position")
NAME = "FakeSystem"


def set_hardware(bench, state: LifecycleState, name: str = NAME) -> None:
    bench.manager.set_hardware_component_state(name, state)


def test_a_controller_rests_while_its_hardware_is_inactive(bench, caplog):
    mover = bench.configure("mover", commands=POSITIONS)
    watcher = bench.configure("watcher", states=POSITIONS)
    bench.switch("mover watcher")
    bench.events.clear()
    set_hardware(bench, LifecycleState.INACTIVE)
    bench.tick(2)
    assert bench.events == ["mover deactivate", *["watcher update"] * 2]
    assert mover.idle_reason == "hardware component 'FakeSystem' is inactive"
    assert watcher.idle_reason == ""
    assert (
        "controllers [ mover ] hold and take no commands: hardware component 'FakeSystem' is "
        "inactive; activate it with: arm control set_hardware_component_state FakeSystem active"
    ) in caplog.text
    [status] = [s for s in bench.manager.list_controllers() if s.name == "mover"]
    assert (status.state, status.claimed_interfaces) == (LifecycleState.ACTIVE, POSITIONS)
    assert status.halted_by == mover.idle_reason
    bench.events.clear()
    set_hardware(bench, LifecycleState.ACTIVE)
    bench.tick()
    assert bench.events == ["mover activate", "mover update", "watcher update"]
    assert mover.idle_reason == ""


def test_the_manager_of_a_namespace_is_named(caplog, bench):
    bench.manager = ControllerManager([bench.hardware], 100, name="/left/controller_manager")
    bench.manager.bring_up()
    bench.configure("mover", commands=POSITIONS)
    bench.switch("mover")
    set_hardware(bench, LifecycleState.INACTIVE)
    assert "FakeSystem active -c /left/controller_manager" in caplog.text


def test_no_command_from_before_moves_a_joint_once_hardware_is_active_again(bench):
    bench.configure("mover", commands=("j0/position",))
    bench.switch("mover")
    bench.hardware.commands[0] = 0.6
    bench.tick()
    set_hardware(bench, LifecycleState.INACTIVE)
    bench.hardware.states[0] = 0.2
    bench.tick(3)
    set_hardware(bench, LifecycleState.ACTIVE)
    assert bench.hardware.commands[0] == 0.2
    # What no controller has commanded yet still has no command.
    assert np.isnan(bench.hardware.commands[1:]).all()


def test_limits_start_again_where_the_joint_is(bench):
    limits = {"j0": JointLimits(-3.0, 3.0, velocity=1.0)}
    bench.manager = manager = ControllerManager([bench.hardware], 100, limits=limits)
    manager.bring_up()
    bench.configure("mover", commands=("j0/position",))
    bench.switch("mover")
    bench.hardware.commands[0] = 0.0
    bench.tick()
    set_hardware(bench, LifecycleState.INACTIVE)
    bench.hardware.states[0] = 0.5
    bench.tick()
    set_hardware(bench, LifecycleState.ACTIVE)
    bench.tick()
    assert bench.hardware.commands[0] == pytest.approx(0.5)


def test_hardware_that_is_cleaned_up_forgets_its_commands(bench):
    bench.configure("mover", commands=("j0/position",))
    bench.switch("mover")
    bench.hardware.commands[0] = 0.6
    set_hardware(bench, LifecycleState.UNCONFIGURED)
    assert bench.states() == {"mover": "inactive"}
    set_hardware(bench, LifecycleState.ACTIVE)
    assert math.isnan(bench.hardware.commands[0])


@pytest.fixture
def two(bench):
    """A manager of two components with one joint each, which also obeys velocities."""
    parts = [
        fake_hardware((joint,), name=name, command_interfaces=("position", "velocity"))
        for joint, name in (("j0", "Left"), ("j1", "Right"))
    ]
    bench.hardware = parts
    bench.manager = ControllerManager(parts, 100)
    bench.manager.bring_up()
    return bench


def test_a_controller_of_two_components_stops_the_joints_of_both(two):
    two.configure("mover", commands=("j0/velocity", "j1/velocity"))
    two.configure("other", commands=("j1/position",))
    two.switch("mover")
    for part in two.hardware:
        part.commands[1] = 2.0
    set_hardware(two, LifecycleState.INACTIVE, "Left")
    two.tick()
    assert two.hardware[1].commands[1] == 0.0
    two.switch("other")


def test_the_emergency_stop_and_inactive_hardware_overlap_in_any_order(bench):
    mover = bench.configure("mover", commands=POSITIONS)
    bench.switch("mover")
    bench.events.clear()
    bench.manager.set_emergency_stop(True)
    set_hardware(bench, LifecycleState.INACTIVE)
    assert mover.idle_reason == "emergency stop"
    bench.manager.set_emergency_stop(False)
    assert mover.idle_reason == "hardware component 'FakeSystem' is inactive"
    bench.manager.set_emergency_stop(True)
    set_hardware(bench, LifecycleState.ACTIVE)
    assert mover.idle_reason == "emergency stop"
    assert bench.events == ["mover deactivate"]
    bench.manager.set_emergency_stop(False)
    assert bench.events == ["mover deactivate", "mover activate"]


def test_hardware_that_moved_during_a_stop_is_held_where_it_is(bench):
    bench.configure("mover", commands=("j0/position",))
    bench.switch("mover")
    bench.manager.set_emergency_stop(True)
    set_hardware(bench, LifecycleState.INACTIVE)
    bench.hardware.states[0] = 0.4
    set_hardware(bench, LifecycleState.ACTIVE)
    bench.tick()
    assert bench.hardware.commands[0] == 0.4


def test_a_controller_on_hardware_that_was_inactive_from_the_start_waits(bench):
    policy = ManagerPolicy(activate_with_inactive_hardware=True)
    bench.manager = ControllerManager([bench.hardware], 100, policy)
    bench.manager.bring_up(inactive=[NAME])
    mover = bench.configure("mover", commands=POSITIONS)
    bench.switch("mover")
    assert mover.idle_reason == "hardware component 'FakeSystem' is inactive"
    set_hardware(bench, LifecycleState.ACTIVE)
    assert mover.idle_reason == ""


def test_hardware_that_deactivates_itself_may_leave_its_controllers_halted(bench):
    from arm_control.hardware.driver import HardwareReturn

    policy = ManagerPolicy(stop_with_self_deactivated_hardware=False)
    bench.manager = ControllerManager([bench.hardware], 100, policy)
    bench.manager.bring_up()
    mover = bench.configure("mover", commands=POSITIONS)
    bench.switch("mover")
    bench.hardware.write_result = HardwareReturn.DEACTIVATE
    bench.tick()
    assert bench.states() == {"mover": "active"}
    assert mover.idle_reason == "hardware component 'FakeSystem' is inactive"


def test_a_snapshot_of_inactive_hardware_under_active_controllers_is_restored(bench):
    mover = bench.configure("mover", commands=POSITIONS)
    bench.hardware.save_state = lambda: None
    bench.hardware.load_state = lambda state: None
    bench.switch("mover")
    set_hardware(bench, LifecycleState.INACTIVE)
    saved = bench.manager.state.save()
    bench.switch("", "mover")
    bench.manager.state.check(saved)
    bench.manager.state.align(saved)
    assert bench.states() == {"mover": "active"}
    assert mover.idle_reason == "hardware component 'FakeSystem' is inactive"


class OneMode(FakeHardware):
    """Hardware whose joints obey one kind of command at a time."""

    modes = ("position", "velocity")


def test_two_controllers_do_not_command_one_joint_that_has_one_mode(bench, caplog):
    kinds = ("position", "velocity", "brightness")
    hardware = OneMode(fake_hardware(("j0", "j1"), command_interfaces=kinds).info)
    bench.manager = ControllerManager([hardware], 100)
    bench.manager.bring_up()
    bench.configure("places", commands=("j0/position",))
    bench.configure("speeds", commands=("j0/velocity",))
    bench.configure("both", commands=("j1/position", "j1/velocity"))
    bench.configure("light", commands=("j0/brightness",))
    request = SwitchRequest(activate=("places", "speeds"))
    assert bench.manager.switch_controller(request).message == PREPARE_REJECTED
    bench.switch("places both light")
    assert not bench.manager.switch_controller(SwitchRequest(("speeds",))).ok
    assert (
        "joint 'j0' obeys one kind of command at a time: controller 'places' claims "
        "'j0/position', and 'speeds' 'j0/velocity'"
    ) in caplog.text
    bench.switch("speeds", "places")
