"""GPIOs of the simulated hardware: interfaces whose states follow their commands."""

import math

import numpy as np
import pytest

from arm_gazebo.hardware.simulated_gpios import SimulatedGpios

GPIO = """
<gpio name="lamp">
  <param name="pin">7</param>
  <command_interface name="on" data_type="bool"/>
  <state_interface name="on" data_type="bool"><param name="initial_value">true</param>
  </state_interface>
</gpio>
<gpio name="valve">
  <command_interface name="opening"><param name="initial_value">0.25</param></command_interface>
  <state_interface name="opening"/>
  <state_interface name="pressure"><param name="initial_value">1.5</param></state_interface>
  <state_interface name="flow"/>
</gpio>
"""
STATES = ("lamp/on", "valve/opening", "valve/pressure", "valve/flow")
COMMANDS = ("lamp/on", "valve/opening")


@pytest.fixture
def arm(bench, parts):
    return bench(parts.pendulum().replace("</ros2_control>", f"{GPIO}</ros2_control>"))


@pytest.fixture
def gpios(arm):
    hardware = arm.hardware

    def values():
        return arm.states[[hardware.state_interfaces.index(name) for name in STATES]]

    return values


def test_they_are_listed_after_the_joints(arm):
    hardware = arm.hardware
    assert hardware.state_interfaces == hardware.info.state_interface_names
    assert hardware.state_interfaces[-4:] == STATES
    assert hardware.command_interfaces[-2:] == COMMANDS
    assert hardware.info.gpios[0].parameters == {"pin": "7"}
    assert hardware.info.data_types["lamp/on"] == "bool"


def test_what_nothing_sets_is_known(arm):
    assert SimulatedGpios(arm.hardware.info).unset == ("valve/flow",)


def test_states_begin_with_their_initial_values(gpios):
    assert gpios() == pytest.approx([1.0, 0.25, 1.5, math.nan], nan_ok=True)


def test_a_command_shows_in_the_state_of_its_name(arm, gpios):
    where = [arm.hardware.command_interfaces.index(name) for name in COMMANDS]
    assert np.isnan(arm.commands[where]).all()
    arm.commands[where[1]] = 0.75
    arm.tick()
    assert gpios() == pytest.approx([1.0, 0.75, 1.5, math.nan], nan_ok=True)
    arm.commands[where[0]] = 0.0
    arm.tick()
    assert gpios() == pytest.approx([0.0, 0.75, 1.5, math.nan], nan_ok=True)


def test_a_reset_gives_them_their_initial_values_again(arm, gpios):
    arm.commands[arm.hardware.command_interfaces.index("lamp/on")] = 0.0
    arm.tick()
    arm.hardware.reset()
    arm.tick()
    assert gpios()[0] == 1.0


def test_joints_are_commanded_beside_them(arm):
    arm.claim()
    arm.command(0.5)
    assert arm.run(2.0)[-1] == pytest.approx([0.5], abs=1e-3)
