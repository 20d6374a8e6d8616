"""The watchdog of the controllers that forward commands: when it holds, what, and for how long."""

import numpy as np
import pytest

from arm_control import SwitchRequest
from arm_control.controllers.forward_command.controller import (
    ForwardCommandController,
    ForwardCommandParameters,
    JointGroupPositionController,
    PositionGroupParameters,
)
from arm_control.testing import FakeHardware, fake_hardware

JOINTS = ("j0", "j1")


@pytest.fixture
def follow(bench, make):
    """Return a maker of an active position controller with a timeout."""

    def active(timeout_s: float) -> JointGroupPositionController:
        parameters = PositionGroupParameters(joints=JOINTS, command_timeout=timeout_s)
        controller = make(JointGroupPositionController, parameters)
        bench.switch("it")
        return controller

    return active


def commanded(bench) -> list[float]:
    return bench.hardware.commands[:2].tolist()


def test_a_stream_of_commands_goes_through(bench, follow, caplog):
    controller = follow(0.05)
    for number in range(50):
        controller.offer([0.01 * number, 0.0])
        bench.tick(4)
        assert commanded(bench) == [0.01 * number, 0.0]
    assert "command_timeout" not in caplog.text


def test_a_stale_command_is_replaced_by_what_is_measured(bench, follow, caplog):
    controller = follow(0.05)
    controller.offer([1.0, -1.0])
    bench.tick(6)
    assert commanded(bench) == [1.0, -1.0]
    bench.hardware.states[:] = 0.25
    bench.tick()
    assert commanded(bench) == [0.25, 0.25]
    assert caplog.text.count("no command for more than 0.05 s (command_timeout): holding") == 1
    bench.hardware.states[:] = 0.5
    bench.tick(20)
    # Held, not followed.
    assert commanded(bench) == [0.25, 0.25]
    assert caplog.text.count("command_timeout") == 1


def test_the_next_command_ends_the_hold(bench, follow, caplog):
    controller = follow(0.05)
    for count, position in enumerate((1.0, 0.5)):
        controller.offer([position, -position])
        bench.tick(2)
        assert commanded(bench) == [position, -position]
        assert caplog.text.count("command_timeout") == count
        bench.tick(10)
    assert caplog.text.count("command_timeout") == 2


def test_it_is_off_by_default(bench, follow):
    controller = follow(PositionGroupParameters().command_timeout)
    controller.offer([1.0, -1.0])
    bench.tick(1000)
    assert commanded(bench) == [1.0, -1.0]
    assert controller.states.names == ()


def test_nothing_becomes_stale_before_the_first_command(bench, follow, caplog):
    follow(0.05)
    bench.tick(100)
    assert np.isnan(commanded(bench)).all()
    assert "command_timeout" not in caplog.text


@pytest.fixture
def turning() -> FakeHardware:
    return fake_hardware(JOINTS, command_interfaces=("velocity",))


def test_a_velocity_becomes_zero(turning):
    from arm_control import ControllerContext, ControllerManager

    manager = ControllerManager([turning], 100)
    manager.bring_up()
    controller = ForwardCommandController(ControllerContext("it", 100))
    manager.load_controller(controller, "test/It")
    parameters = ForwardCommandParameters(JOINTS, "velocity", command_timeout=0.1)
    manager.configure_controller("it", parameters)
    assert manager.switch_controller(SwitchRequest(activate=("it",))).ok
    controller.offer([0.5, 0.5])
    for tick in range(12):
        assert turning.commands.tolist() == [0.5, 0.5] or tick == 0
        manager.update(0.01 * tick, 0.01)
    assert turning.commands.tolist() == [0.0, 0.0]


@pytest.mark.parametrize("ticks", [0, 3])
def test_a_restored_command_is_as_old_as_it_was(bench, follow, ticks):
    controller = follow(0.05)
    controller.offer([1.0, -1.0])
    bench.tick(ticks)
    saved = controller.save_state()
    bench.tick(2)
    controller.load_state(saved)
    bench.hardware.states[:] = 0.25
    # The sixth update after the one that saw it is the first that is late.
    bench.tick(6 - ticks)
    assert commanded(bench) == [1.0, -1.0]
    bench.hardware.states[:] = 0.25
    bench.tick()
    assert commanded(bench) == [0.25, 0.25]
