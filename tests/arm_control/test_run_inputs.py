from collections.abc import Mapping

import pytest

from arm_control.controllers.controller import ControllerContext
from arm_control.controllers.forward_command.controller import (
    ForwardCommandParameters,
    JointGroupPositionController,
)
from arm_control.manager.controller_manager import ControllerManager
from arm_control.run_inputs import InputGate, run_input, run_input_noted_as


class Gate:
    """Notes inputs, and lets them through."""

    def __init__(self):
        self.inputs: list[tuple[object, str, Mapping[str, object]]] = []

    def give(self, target, method, arguments, act):
        self.inputs.append((target, method, arguments))
        return act()


class Lamp:
    input_gate: InputGate | None = None
    brightness = 0.0

    @run_input
    def dim(self, brightness: float, slowly: bool = False) -> str:
        self.brightness = brightness
        return "dimmed"

    @run_input_noted_as(lambda arguments: {"bulb": arguments["bulb"].__name__})
    def change(self, bulb: type) -> None:
        """Change the bulb."""


def test_without_a_gate_an_input_is_an_ordinary_method():
    lamp = Lamp()
    assert lamp.dim(0.5) == "dimmed"
    assert lamp.brightness == 0.5


def test_a_gate_is_given_target_method_and_arguments_by_name():
    lamp = Lamp()
    lamp.input_gate = gate = Gate()
    assert lamp.dim(0.5, slowly=True) == "dimmed"
    assert gate.inputs == [(lamp, "dim", {"brightness": 0.5, "slowly": True})]
    assert lamp.brightness == 0.5


def test_arguments_that_are_not_data_are_noted_as_data():
    lamp = Lamp()
    lamp.input_gate = gate = Gate()
    lamp.change(int)
    assert gate.inputs == [(lamp, "change", {"bulb": "int"})]


def test_an_exception_of_an_input_reaches_the_caller():
    lamp = Lamp()
    lamp.input_gate = Gate()
    with pytest.raises(TypeError):
        lamp.dim(1.0, quickly=True)  # pyright: ignore[reportCallIssue]


def test_a_manager_hands_its_gate_to_its_controllers():
    manager = ControllerManager((), 100)
    first, second = (
        JointGroupPositionController(ControllerContext(name, 100)) for name in ("first", "second")
    )
    manager.load_controller(first, "a_type")
    gate = Gate()
    manager.set_input_gate(gate)
    manager.load_controller(second, "a_type")
    manager.configure_controller("first", ForwardCommandParameters(joints=("j0",)))
    for controller in (first, second):
        controller.offer([1.0])
    assert [(target, method) for target, method, _ in gate.inputs] == [
        (manager, "load_controller"),
        (manager, "configure_controller"),
        (first, "offer"),
        (second, "offer"),
    ]
    assert gate.inputs[0][2] == {"controller": "second", "type_name": "a_type"}
    manager.set_input_gate(None)
    first.offer([2.0])
    assert len(gate.inputs) == 4


def test_a_manager_knows_what_its_controllers_were_configured_with():
    manager = ControllerManager((), 100)
    controller = JointGroupPositionController(ControllerContext("first", 100))
    manager.load_controller(controller, "a_type")
    assert manager.controllers["first"].controller is controller
    assert controller.configured_with is None
    first, second = (ForwardCommandParameters(joints=(joint,)) for joint in ("j0", "j1"))
    manager.configure_controller("first", first, 50)
    assert controller.configured_with == first
    assert manager.controllers["first"].requested_rate_hz == 50
    controller.change_parameters(second)
    assert controller.configured_with == second
