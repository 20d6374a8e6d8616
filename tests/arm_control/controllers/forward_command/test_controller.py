"""Commands in, commands out, and commands that must be refused."""

from array import array
from typing import Any

import numpy as np
import pytest

from arm_control import ControllerContext, ControllerManager, ControllerManagerError
from arm_control.controllers.forward_command.controller import (
    EffortGroupParameters,
    ForwardCommandController,
    ForwardCommandParameters,
    JointGroupEffortController,
    JointGroupPositionController,
    JointGroupVelocityController,
    JointPositionController,
    JointPositionParameters,
    MultiInterfaceForwardCommandController,
    MultiInterfaceForwardCommandParameters,
    PidParameters,
    PositionGroupParameters,
    VelocityGroupParameters,
)
from arm_control.testing import fake_hardware

JOINTS = ("j0", "j1", "j2", "j3")


@pytest.fixture
def position(bench, make) -> JointGroupPositionController:
    """Return an active position controller of all four joints."""
    controller = make(JointGroupPositionController, PositionGroupParameters(joints=JOINTS))
    bench.switch("it")
    return controller


def commands(bench: Any) -> list[float]:
    return bench.manager.resources.commands.tolist()


def test_a_command_reaches_its_interfaces(bench, position):
    position.offer([0.1, 0.2, 0.3, 0.4])
    bench.tick()
    assert commands(bench) == [0.1, 0.2, 0.3, 0.4]


def test_the_order_is_that_of_the_joints_parameter(bench, make):
    controller = make(JointGroupPositionController, PositionGroupParameters(joints=("j2", "j0")))
    bench.switch("it")
    controller.offer([2.0, 0.0])
    bench.tick()
    assert commands(bench)[0::2] == [0.0, 2.0]


def test_the_last_command_wins(bench, position):
    position.offer([1.0] * 4)
    position.offer([2.0] * 4)
    bench.tick()
    assert commands(bench) == [2.0] * 4


def test_the_command_is_written_in_every_cycle(bench, position):
    position.offer([1.0] * 4)
    bench.tick()
    bench.manager.resources.commands[:] = 0.0
    bench.tick()
    assert commands(bench) == [1.0] * 4


def test_a_message_buffer_that_changes_later_does_no_harm(bench, position):
    buffer = array("d", [1.0] * 4)
    position.offer(buffer)
    buffer[0] = 9.0
    bench.tick()
    assert commands(bench) == [1.0] * 4


def test_before_the_first_command_nothing_is_written(bench, position):
    bench.tick()
    assert np.isnan(commands(bench)).all()


def test_an_empty_command_is_ignored(bench, position):
    position.offer([1.0] * 4)
    bench.tick()
    assert position.offer([])
    bench.tick(2)
    assert commands(bench) == [1.0] * 4
    assert bench.states() == {"it": "active"}


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_a_command_that_is_not_finite_is_dropped_whole(bench, position, bad):
    position.offer([1.0] * 4)
    assert not position.offer([0.0, bad, 0.0, 0.0])
    bench.tick()
    assert commands(bench) == [1.0] * 4
    assert bench.states() == {"it": "active"}


@pytest.mark.parametrize("length", [1, 3, 5, 100_000])
def test_a_wrong_length_deactivates_the_controller(bench, position, length, caplog):
    assert position.offer([1.0] * length)
    bench.tick()
    assert bench.states() == {"it": "inactive"}
    assert np.isnan(commands(bench)).all()
    assert f"command size ({length}) does not match number of interfaces (4)" in caplog.text
    assert "Deactivating controllers : [ it ] as their update resulted in an error!" in caplog.text


def test_activation_clears_a_wrong_length(bench, position):
    position.offer([1.0])
    bench.tick()
    bench.switch("it")
    bench.tick(2)
    assert bench.states() == {"it": "active"}


def test_what_came_while_inactive_is_not_replayed(bench, position):
    bench.switch("", "it")
    position.offer([1.0] * 4)
    bench.switch("it")
    bench.tick()
    assert np.isnan(commands(bench)).all()


def test_an_inactive_controller_moves_nothing(bench, position):
    bench.switch("", "it")
    position.offer([1.0] * 4)
    bench.tick()
    assert np.isnan(commands(bench)).all()


def test_position_keeps_its_command_after_deactivation(bench, position):
    position.offer([1.0] * 4)
    bench.tick()
    bench.switch("", "it")
    assert commands(bench) == [1.0] * 4


@pytest.mark.parametrize(
    ("class_", "parameters", "interface"),
    [
        (JointGroupVelocityController, VelocityGroupParameters, "velocity"),
        (JointGroupEffortController, EffortGroupParameters, "effort"),
    ],
)
def test_velocity_and_effort_go_to_zero_when_they_end(bench, make, class_, parameters, interface):
    bench.manager = ControllerManager([fake_hardware(command_interfaces=(interface,))], 100)
    bench.manager.bring_up()
    controller = make(class_, parameters(joints=JOINTS))
    bench.switch("it")
    controller.offer([1.0] * 4)
    bench.tick()
    bench.switch("", "it")
    assert commands(bench) == [0.0] * 4


def test_the_forward_controller_takes_any_interface(bench, make):
    controller = make(
        ForwardCommandController, ForwardCommandParameters(("j1",), interface_name="position")
    )
    bench.switch("it")
    controller.offer([5.0])
    bench.tick()
    assert commands(bench)[1] == 5.0


def test_the_multi_interface_controller_commands_one_joint(bench, make):
    bench.manager = ControllerManager(
        [fake_hardware(command_interfaces=("position", "velocity", "effort"))], 100
    )
    bench.manager.bring_up()
    controller = make(
        MultiInterfaceForwardCommandController,
        MultiInterfaceForwardCommandParameters("j1", ("effort", "position")),
    )
    bench.switch("it")
    controller.offer([7.0, 8.0])
    bench.tick()
    assert commands(bench)[3:6:2] == [8.0, 7.0]


@pytest.mark.parametrize(
    ("class_", "interface", "other"),
    [
        (JointGroupPositionController, "position", "velocity"),
        (JointGroupVelocityController, "velocity", "effort"),
        (JointGroupEffortController, "effort", "position"),
    ],
)
def test_the_interface_of_a_group_is_fixed(class_, interface, other, caplog):
    controller = class_(ControllerContext("it", 100))
    for given in ({}, {"interface_name": other}):
        assert not caplog.messages
        controller.on_configure(class_.build_parameters({"joints": ["j0"], **given}))
        names = controller.command_interface_configuration().names
        assert names == (f"j0/{interface}",)
    assert f"interface_name '{other}' has no effect" in caplog.text


@pytest.mark.parametrize(
    ("class_", "parameters", "missing"),
    [
        (JointGroupPositionController, PositionGroupParameters(), "joints"),
        (ForwardCommandController, ForwardCommandParameters(), "joints"),
        (ForwardCommandController, ForwardCommandParameters(("j0",)), "interface_name"),
        (MultiInterfaceForwardCommandController, MultiInterfaceForwardCommandParameters(), "joint"),
        (
            MultiInterfaceForwardCommandController,
            MultiInterfaceForwardCommandParameters("j0"),
            "interface_names",
        ),
    ],
)
def test_an_empty_parameter_fails_the_configuration(make, class_, parameters, missing):
    with pytest.raises(ControllerManagerError, match=f"'{missing}' parameter was empty"):
        make(class_, parameters)


def test_a_joint_position_controller_commands_its_one_joint(bench, make):
    controller = make(JointPositionController, JointPositionParameters(joint="j2"))
    bench.switch("it")
    controller.offer([0.7])
    bench.tick()
    assert commands(bench)[2] == 0.7


def test_a_joint_position_controller_logs_that_gains_have_no_effect(make, caplog):
    caplog.set_level("INFO")
    parameters = JointPositionParameters("j2", PidParameters(p=100.0, i=0.01, d=10.0))
    make(JointPositionController, parameters)
    assert "the gains under 'pid' have no effect" in caplog.text


def test_a_joint_position_controller_without_a_joint_is_refused(make):
    with pytest.raises(ControllerManagerError, match="'joint' parameter was empty"):
        make(JointPositionController, JointPositionParameters())
