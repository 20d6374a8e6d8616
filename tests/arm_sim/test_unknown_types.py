"""Controllers of unknown types in a file that a program simulates."""

import warnings
from pathlib import Path

import pytest

from arm_gazebo.errors import SimSettingsError
from arm_sim import Simulation

CONTROLLERS = {
    "controller_manager": {
        "ros__parameters": {
            "position_controller": {"type": "position_controllers/JointGroupPositionController"},
            "scaled": {"type": "ur_controllers/ScaledJointTrajectoryController"},
            "admittance": {"type": "admittance_controller/AdmittanceController"},
        }
    },
    "position_controller": {"ros__parameters": {"joints": ["j0"]}},
}


def test_those_that_the_suite_lacks_are_a_warning_at_the_users_line():
    with (
        pytest.warns(UserWarning, match="2 controllers are left out") as caught,
        Simulation(controllers=CONTROLLERS) as sim,
    ):
        assert set(sim.controllers) == {"position_controller"}
    (warning,) = caught
    assert str(warning.message) == (
        "2 controllers are left out, because the suite has no controller of the type: "
        "scaled (ur_controllers/ScaledJointTrajectoryController), "
        "admittance (admittance_controller/AdmittanceController)"
    )
    assert Path(warning.filename) == Path(__file__)


def test_a_misspelt_type_is_an_error():
    content = {
        "controller_manager": {
            "ros__parameters": {"arm": {"type": "position_controllers/JointGroupPositionControler"}}
        }
    }
    sentence = (
        r"arm: no controller type '.*Controler'; "
        r"did you mean 'position_controllers/JointGroupPositionController'"
    )
    with pytest.raises(SimSettingsError, match=sentence):
        Simulation(controllers=content)


def test_what_the_user_leaves_out_himself_is_not_mentioned():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with Simulation(controllers=CONTROLLERS, spawn=["position_controller"]) as sim:
            assert list(sim.controllers) == ["position_controller"]
