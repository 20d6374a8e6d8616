"""The shipped YAML files."""

from pathlib import Path
from typing import Any

import pytest
import yaml

from arm_control.controllers.forward_command.controller import JointPositionController
from arm_control.manager.parameter_file import ControllerParameterFile
from arm_control.manager.registry import controller_class
from arm_control.parameters import build_parameters

FOLDER = Path(__file__).parents[2] / "arm_control" / "config"
PATH = FOLDER / "arm_control.yaml"
ROS1_PATH = FOLDER / "arm_control_ros1.yaml"


@pytest.fixture
def content() -> dict[str, Any]:
    return yaml.safe_load(PATH.read_text())


def test_it_declares_the_three_controllers_at_100_hz(content):
    manager = content["controller_manager"]["ros__parameters"]
    assert manager.pop("update_rate") == 100
    assert {name: entry["type"] for name, entry in manager.items()} == {
        "joint_state_broadcaster": "joint_state_broadcaster/JointStateBroadcaster",
        "position_controller": "position_controllers/JointGroupPositionController",
        "joint_trajectory_controller": "joint_trajectory_controller/JointTrajectoryController",
    }


@pytest.mark.parametrize("name", ["joint_state_broadcaster", "position_controller"])
def test_every_parameter_is_known_to_its_controller(content, name):
    type_name = ControllerParameterFile(str(PATH)).lookup(name, "/", "type")
    parameters_type = controller_class(type_name).parameters_type
    built = build_parameters(parameters_type, content[name]["ros__parameters"])
    assert isinstance(built, parameters_type)


def test_the_controllers_command_the_arms_four_joints(content):
    for name in ("position_controller", "joint_trajectory_controller"):
        assert content[name]["ros__parameters"]["joints"] == ["j0", "j1", "j2", "j3"]


def test_the_ros1_form_has_a_controller_for_each_joint_under_arm():
    parameters = yaml.safe_load(ROS1_PATH.read_text())
    manager = parameters["/arm/controller_manager"]["ros__parameters"]
    for index in range(4):
        name = f"j{index}p_controller"
        own = parameters[f"/arm/{name}"]["ros__parameters"]
        gains = {f"pid.{gain}": value for gain, value in own.pop("pid").items()}
        built = JointPositionController.build_parameters({**own, **gains})
        assert built.joint == f"j{index}"
        assert (built.pid.p, built.pid.i, built.pid.d) == (100.0, 0.01, 10.0)
        assert controller_class(manager[name]["type"]) is JointPositionController


def test_the_ros1_form_publishes_states_at_50_hz():
    file = ControllerParameterFile(str(ROS1_PATH))
    assert file.lookup("joint_state_broadcaster", "/arm", "update_rate") == 50
