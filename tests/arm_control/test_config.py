"""The shipped YAML."""

from pathlib import Path
from typing import Any

import pytest
import yaml

from arm_control.controller_parameter_file import ControllerParameterFile
from arm_control.parameters import build_parameters
from arm_control.registry import controller_class

PATH = Path(__file__).parents[2] / "arm_control" / "config" / "arm_control.yaml"


@pytest.fixture
def content() -> dict[str, Any]:
    return yaml.safe_load(PATH.read_text())


def test_it_declares_the_three_controllers_at_100_hz(content: dict[str, Any]) -> None:
    manager = content["controller_manager"]["ros__parameters"]
    assert manager.pop("update_rate") == 100
    assert {name: entry["type"] for name, entry in manager.items()} == {
        "joint_state_broadcaster": "joint_state_broadcaster/JointStateBroadcaster",
        "position_controller": "position_controllers/JointGroupPositionController",
        "joint_trajectory_controller": "joint_trajectory_controller/JointTrajectoryController",
    }


@pytest.mark.parametrize("name", ["joint_state_broadcaster", "position_controller"])
def test_every_parameter_is_known_to_its_controller(content: dict[str, Any], name: str) -> None:
    type_name = ControllerParameterFile(str(PATH)).lookup(name, "/", "type")
    parameters = content[name]["ros__parameters"]
    build_parameters(controller_class(type_name).parameters_type, parameters)


def test_the_controllers_command_the_arms_four_joints(content: dict[str, Any]) -> None:
    for name in ("position_controller", "joint_trajectory_controller"):
        assert content[name]["ros__parameters"]["joints"] == ["j0", "j1", "j2", "j3"]
