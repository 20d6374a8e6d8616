"""The fakes that other packages' tests rely on."""

import numpy as np

from arm_control.testing import FakeHardware, ManualClock, fake_hardware


def bound(hardware: FakeHardware) -> FakeHardware:
    hardware.bind(
        np.full(len(hardware.state_interfaces), np.nan),
        np.full(len(hardware.command_interfaces), np.nan),
    )
    hardware.on_configure()
    return hardware


def test_a_manual_clock_moves_on_request():
    clock = ManualClock(2.0)
    clock.advance(0.5)
    assert clock.now_s() == 2.5


def test_states_start_at_their_initial_values():
    hardware = bound(fake_hardware(("a",), initial_positions={"a": 0.3}))
    assert hardware.states.tolist() == [0.3, 0.0, 0.0]


def test_states_follow_the_commands_that_were_given():
    hardware = bound(fake_hardware(("a", "b")))
    hardware.commands[1] = 0.7
    hardware.write(0.0, 0.01)
    assert hardware.states.tolist() == [0.0, 0.0, 0.0, 0.7, 0.0, 0.0]


def test_states_are_unmeasured_on_demand():
    hardware = bound(fake_hardware(("a",), initial_positions={"a": 0.3}))
    hardware.unmeasured = {"a/position"}
    hardware.read(0.0, 0.01)
    assert np.isnan(hardware.states).tolist() == [True, False, False]
    hardware.unmeasured.clear()
    hardware.read(0.0, 0.01)
    assert hardware.states.tolist() == [0.3, 0.0, 0.0]


def test_life_cycle_methods_refuse_on_demand():
    hardware = fake_hardware()
    hardware.refused.add("on_activate")
    assert (hardware.on_activate(), hardware.on_deactivate()) == (False, True)
    assert hardware.events == ["on_activate", "on_deactivate"]
