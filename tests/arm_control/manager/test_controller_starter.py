"""Controllers start without ROS from what a parameter file says."""

import logging
from typing import Any

import pytest

from arm_control.errors import ArmControlError, ControllerManagerError, ParameterError
from arm_control.lifecycle import LifecycleState
from arm_control.manager.controller_creation import ControllerStarter, manager_settings
from arm_control.manager.controller_manager import ControllerManager
from arm_control.manager.parameter_file import ParametersByNode
from arm_control.testing import fake_hardware

FORWARD = "position_controllers/JointGroupPositionController"


def running_manager() -> ControllerManager:
    manager = ControllerManager([fake_hardware()], 100)
    manager.bring_up()
    return manager


def starter(content: dict[str, Any], namespace: str = "/") -> ControllerStarter:
    parameters = ParametersByNode(content, "the file")
    return ControllerStarter(running_manager(), parameters, "", namespace)


def file(manager: dict[str, Any], **controllers: dict[str, Any]) -> dict[str, Any]:
    nodes = {"controller_manager": manager, **controllers}
    return {name: {"ros__parameters": values} for name, values in nodes.items()}


def test_a_controller_is_loaded_configured_and_activated():
    content = file({"ctrl": {"type": FORWARD}}, ctrl={"joints": ["j1", "j0"], "update_rate": 50})
    manager = running_manager()
    controller = ControllerStarter(manager, ParametersByNode(content, "the file")).start("ctrl")
    assert controller.command_interface_configuration().names == ("j1/position", "j0/position")
    (status,) = manager.list_controllers()
    assert (status.state, status.update_rate_hz) == (LifecycleState.ACTIVE, 50)


def test_the_type_may_stand_in_the_controller_s_own_entry():
    started = starter({"ctrl": {"ros__parameters": {"type": FORWARD, "joints": ["j0"]}}})
    assert type(started.start("ctrl")).__name__ == "JointGroupPositionController"


def test_a_file_of_its_own_overrides_the_common_one(tmp_path):
    own = tmp_path / "own.yaml"
    own.write_text("ctrl: {ros__parameters: {joints: [j2]}}")
    content = file({"ctrl": {"type": FORWARD, "params_file": str(own)}}, ctrl={"joints": ["j0"]})
    controller = starter(content).start("ctrl")
    assert controller.command_interface_configuration().names == ("j2/position",)


def test_parameters_of_a_namespace_are_found():
    content = {
        "/left/controller_manager": {"ros__parameters": {"ctrl": {"type": FORWARD}}},
        "/left/ctrl": {"ros__parameters": {"joints": ["j0"]}},
    }
    assert starter(content, "/left").start("ctrl").name == "ctrl"


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (file({}), "The 'type' param was not defined for 'ctrl'. It is defined for nothing"),
        (file({"ctrl": {"type": 3}}), "'ctrl.type' must be a string or a list of strings, not 3"),
        (file({"ctrl": {"type": "no/Type"}}), "no controller type 'no/Type'; known:"),
        (file({"ctrl": {"type": FORWARD}}), "'joints' parameter was empty"),
        (file({"ctrl": {"type": FORWARD}}, ctrl={"joints": 1}), "controller 'ctrl': parameter 'jo"),
        (
            file({"ctrl": {"type": FORWARD}}, ctrl={"joints": ["j0"], "update_rate": -1}),
            "controller 'ctrl': parameter 'update_rate' must not be negative, but is -1",
        ),
        ({"ctrl": {"parameters": {}}}, "the file: 'ctrl' has no mapping ros__parameters"),
    ],
)
def test_what_is_wrong_gets_the_sentence_of_the_manager(content, message):
    with pytest.raises(ArmControlError, match=message):
        starter(content).start("ctrl")


def test_an_interface_that_another_controller_has_is_refused():
    both = {name: {"type": FORWARD} for name in ("one", "two")}
    started = starter(file(both, one={"joints": ["j0"]}, two={"joints": ["j0"]}))
    started.start("one")
    with pytest.raises(ControllerManagerError):
        started.start("two")


def test_unknown_parameters_are_warned_of(caplog):
    content = file({"ctrl": {"type": FORWARD}}, ctrl={"joints": ["j0"], "joynts": ["j1"]})
    with caplog.at_level(logging.WARNING):
        starter(content).start("ctrl")
    assert "parameter 'joynts' is not known to JointGroupPositionController" in caplog.text


def test_the_manager_s_settings_leave_out_what_belongs_to_controllers():
    content = file({"update_rate": 50, "defaults": {"switch_controller": {"strictness": "strict"}}})
    settings = manager_settings(ParametersByNode(content, "the file"))
    assert settings.update_rate == 50
    assert settings.defaults.switch_controller.strictness == "strict"
    with pytest.raises(ParameterError, match="'update_rate' must be above 0, but is 0"):
        manager_settings(ParametersByNode(file({"update_rate": 0}), "the file"))
