"""The core of the GPIO controller, on mock hardware."""

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from arm_control import ControllerContext, ControllerError, ControllerManager, SwitchRequest
from arm_control.controllers.gpio_command.controller import (
    GpioCommandController,
    GpioCommandParameters,
)
from arm_control.errors import ParameterError
from arm_control.hardware.info import parse_hardware_info
from arm_control.hardware.mock_components import GenericSystem

TYPE = "gpio_controllers/GpioCommandController"
ROBOT = """<robot name="r"><ros2_control name="io" type="system">
<hardware><plugin>mock_components/GenericSystem</plugin></hardware>
<gpio name="lamp"><command_interface name="on"/><state_interface name="on"/></gpio>
<gpio name="valve"><command_interface name="opening"/><command_interface name="speed"/>
<state_interface name="opening"><param name="initial_value">0.5</param></state_interface>
<state_interface name="flow"/></gpio></ros2_control></robot>"""
GIVEN = {
    "gpios": ["lamp", "valve"],
    "command_interfaces.lamp.interfaces": ["on"],
    "command_interfaces.valve.interfaces": ["opening", "speed"],
}


class Sink:
    """Records what was published."""

    def __init__(self) -> None:
        self.published: list[tuple[float, list[float]]] = []

    def wanted(self) -> bool:
        return True

    def publish(self, time_s: float, states: NDArray[np.float64]) -> None:
        self.published.append((time_s, states.tolist()))


class Running:
    """An active controller in a manager."""

    def __init__(self, given: dict[str, Any]) -> None:
        self.controller = GpioCommandController(ControllerContext("gpios", 100, ROBOT))
        self.sink = Sink()
        self.controller.sink = self.sink
        (info,) = parse_hardware_info(ROBOT)
        self.manager = ControllerManager([GenericSystem(info)], 100)
        self.manager.bring_up()
        self.manager.load_controller(self.controller, TYPE)
        parameters = GpioCommandController.build_parameters(given)
        self.manager.configure_controller("gpios", parameters)
        self.ticks = 0
        self.activate()

    def activate(self) -> None:
        result = self.manager.switch_controller(SwitchRequest(activate=("gpios",)))
        assert result.ok, result.message

    def tick(self) -> list[float]:
        """Run a cycle and return the states that were published in it."""
        self.ticks += 1
        self.manager.read(self.ticks * 0.01, 0.01)
        self.manager.update(self.ticks * 0.01, 0.01)
        self.manager.write(self.ticks * 0.01, 0.01)
        return self.sink.published[-1][1]


@pytest.fixture
def running():
    return Running(GIVEN)


def test_parameters_are_named_after_the_gpios():
    names = [spec.name for spec in GpioCommandController.parameter_specs(GIVEN)]
    assert names == [
        "gpios",
        "command_interfaces.lamp.interfaces",
        "state_interfaces.lamp.interfaces",
        "command_interfaces.valve.interfaces",
        "state_interfaces.valve.interfaces",
    ]
    assert all(spec.read_only for spec in GpioCommandController.parameter_specs(GIVEN))
    with pytest.raises(ParameterError, match=r"unknown parameter command_interfaces\.door"):
        GpioCommandController.build_parameters({**GIVEN, "command_interfaces.door.interfaces": []})


def test_without_state_interfaces_it_shows_those_of_the_description(running):
    assert running.controller.shown == {"lamp": ("on",), "valve": ("opening", "flow")}
    assert running.tick() == pytest.approx([np.nan, 0.5, np.nan], nan_ok=True)


def test_with_state_interfaces_it_shows_those():
    only = Running({**GIVEN, "state_interfaces.valve.interfaces": ["opening"]})
    assert only.controller.shown == {"lamp": (), "valve": ("opening",)}
    assert only.tick() == [0.5]


def test_a_command_sets_what_it_names_and_the_rest_keeps_its_value(running):
    assert running.controller.offer(["valve/opening"], [0.7]) == ""
    running.tick()
    assert running.tick()[1] == 0.7
    # Both of one cycle count, although they set different interfaces.
    assert running.controller.offer(["lamp/on"], [1.0]) == ""
    assert running.controller.offer(["valve/opening"], [0.2]) == ""
    running.tick()
    assert running.tick()[:2] == [1.0, 0.2]


def test_a_program_gives_all_commands_in_the_order_of_the_parameters(running):
    running.controller.take_command([1.0, 0.1, 3.0])
    running.tick()
    assert running.tick()[:2] == [1.0, 0.1]
    with pytest.raises(ControllerError, match="it has 3 interfaces and 1 values"):
        running.controller.take_command([1.0])


@pytest.mark.parametrize(
    ("names", "values", "reason"),
    [
        (["lamp/off"], [1.0], "no command interface lamp/off; the controller has lamp/on, valve/"),
        (["lamp/on"], [float("nan")], "a value is not a finite number"),
        (["lamp/on", "valve/speed"], [1.0], "it has 2 interfaces and 1 values"),
    ],
)
def test_a_command_that_cannot_be_is_refused_whole(running, names, values, reason):
    assert running.controller.offer(names, values).startswith(reason)
    running.tick()
    assert running.tick() == pytest.approx([np.nan, 0.5, np.nan], nan_ok=True)


def test_outputs_stay_when_it_is_deactivated_and_old_commands_are_dropped(running):
    running.controller.offer(["lamp/on"], [1.0])
    running.tick()
    running.manager.switch_controller(SwitchRequest(deactivate=("gpios",)))
    running.controller.offer(["lamp/on"], [0.0])
    running.activate()
    running.tick()
    assert running.tick()[0] == 1.0


@pytest.mark.parametrize(
    ("given", "reason"),
    [
        ({}, "'gpios' parameter was empty"),
        ({"gpios": ["lamp", "lamp"]}, "lamp: named twice"),
        ({"gpios": ["door"]}, "No command or state interfaces are configured"),
        (
            {"gpios": ["lamp"], "command_interfaces.lamp.interfaces": ["on", "on"]},
            "lamp/on: named twice",
        ),
    ],
)
def test_parameters_that_name_nothing_or_something_twice_are_refused(given, reason):
    controller = GpioCommandController(ControllerContext("gpios", 100, ROBOT))
    parameters: GpioCommandParameters = GpioCommandController.build_parameters(given)
    with pytest.raises(ControllerError, match=reason):
        controller.on_configure(parameters)
