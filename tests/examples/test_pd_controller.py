"""The example's controller, on fake hardware."""

import numpy as np
import pytest

from arm_control import (
    ControllerContext,
    ControllerError,
    ControllerManager,
    LifecycleState,
    SwitchRequest,
)
from arm_control.testing import FakeHardware, fake_hardware


@pytest.fixture
def hardware() -> FakeHardware:
    return fake_hardware(
        ("j0", "j1"), command_interfaces=("effort",), state_interfaces=("position", "velocity")
    )


@pytest.fixture
def controller():
    from servo_arm.pd_controller import PdController

    return PdController(ControllerContext("pd", 100))


@pytest.fixture
def manager(hardware, controller) -> ControllerManager:
    manager = ControllerManager([hardware], 100)
    manager.bring_up()
    manager.load_controller(controller, "servo_arm/PdController", ())
    parameters = {"joints": ("j0", "j1"), "target": 1.0, "p": 2.0, "d": 0.5}
    manager.configure_controller("pd", controller.build_parameters(parameters), 100)
    assert manager.switch_controller(SwitchRequest(activate=("pd",))).ok
    return manager


def test_it_pulls_to_the_target_and_brakes(manager, hardware):
    hardware.states[:] = (0.5, 0.1, 2.0, 0.0)
    manager.update(0.0, 0.01)
    assert hardware.commands == pytest.approx([2.0 * 0.5 - 0.5 * 0.1, -2.0])


def test_its_parameters_change_under_way(manager, hardware, controller):
    values = {"joints": ("j0", "j1"), "target": 0.0, "p": 1.0, "d": 0.0}
    controller.update_parameters(controller.build_parameters(values))
    hardware.states[:] = (0.5, 0.1, 2.0, 0.0)
    manager.update(0.0, 0.01)
    assert hardware.commands == pytest.approx([-0.5, -2.0])


def test_it_lets_go_at_the_end(manager, hardware):
    manager.update(0.0, 0.01)
    assert np.abs(hardware.commands).min() > 0.0
    assert manager.switch_controller(SwitchRequest(deactivate=("pd",))).ok
    assert hardware.commands.tolist() == [0.0, 0.0]
    assert manager.list_controllers()[0].state is LifecycleState.INACTIVE


def test_it_has_no_parameters_before_it_is_configured(controller):
    with pytest.raises(ControllerError, match="controller 'pd' is not configured"):
        _ = controller.parameters
