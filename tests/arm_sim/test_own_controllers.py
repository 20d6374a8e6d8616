"""Controllers, parameters and descriptions of a user's own in the library."""

from collections.abc import Iterator
from pathlib import Path

import pytest
from robots import pendulum

from arm_control.errors import ParameterError
from arm_gazebo.errors import SimSettingsError
from arm_sim import Simulation, UnknownNameError

EXAMPLE = Path(__file__).parents[2] / "examples" / "servo_arm"
PENDULUM = pendulum()
CONTROLLERS = {
    "controller_manager": {
        "ros__parameters": {
            "update_rate": 50,
            "hinge_controller": {"type": "position_controllers/JointGroupPositionController"},
        }
    },
    "hinge_controller": {"ros__parameters": {"joints": ["hinge"]}},
}


OWN_CONTROLLER = {
    "controller_manager": {
        "ros__parameters": {"pd_controller": {"type": "servo_arm/PdController"}}
    },
    "pd_controller": {"ros__parameters": {"joints": ["hinge"], "p": 2.0, "d": 0.3}},
}


@pytest.fixture
def servo_arm(tmp_path, monkeypatch) -> None:
    """The example package, as if it were installed with its entry points."""
    described = tmp_path / "servo_arm-0.1.0.dist-info"
    described.mkdir()
    (described / "METADATA").write_text("Name: servo-arm\nVersion: 0.1.0\n")
    (described / "entry_points.txt").write_text(
        "[arm_control.controllers]\nservo_arm/PdController = servo_arm.pd_controller:PdController\n"
    )
    for folder in (tmp_path, EXAMPLE):
        monkeypatch.syspath_prepend(str(folder))


@pytest.fixture
def driven(servo_arm) -> Iterator[Simulation]:
    """A pendulum that the example's controller drives."""
    with Simulation(PENDULUM, controllers=OWN_CONTROLLER) as sim:
        yield sim


def test_a_controller_of_an_installed_package_runs(driven):
    driven.controllers.set_parameters("pd_controller", target=0.5)
    driven.run(5.0)
    assert driven.joints["hinge"].position == pytest.approx(0.5, abs=0.02)


def test_hardware_of_a_user_s_own_is_simulated_as_in_the_node(servo_arm):
    folder = EXAMPLE / "config" / "controllers.yaml"
    with Simulation(EXAMPLE / "urdf" / "servo_arm.urdf.xacro", controllers=folder) as sim:
        assert sim.controllers["pd_controller"].is_active
        assert set(sim.states) == {
            f"{joint}/{kind}"
            for joint in ("shoulder", "elbow")
            for kind in ("position", "velocity")
        }


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"aim": 1.0}, "'pd_controller': unknown parameter aim; known: joints, target, p, d"),
        ({"joints": ["knee"]}, "parameter 'joints' is read-only"),
        ({"p": "much"}, "parameter 'p' must be of type float, not 'much'"),
    ],
)
def test_a_parameter_that_cannot_be_changed_gets_a_sentence(driven, values, message):
    with pytest.raises(ParameterError, match=message):
        driven.controllers.set_parameters("pd_controller", **values)


def test_a_parameter_of_the_configuration_is_not_changed_later(sim):
    with pytest.raises(ParameterError, match="'joints' takes effect only when the controller is"):
        sim.controllers.set_parameters("position_controller", joints=["j0"])
    with pytest.raises(UnknownNameError, match="no controller 'x'"):
        sim.controllers.set_parameters("x")


def test_description_and_parameters_may_be_given_as_values():
    with Simulation(PENDULUM, controllers=CONTROLLERS) as sim:
        assert sim.period_s == pytest.approx(0.02)
        sim["hinge_controller"].command([0.5])
        sim.run(1.0)
        assert sim.joints["hinge"].position == pytest.approx(0.5, abs=1e-3)


def test_values_that_cannot_be_used_get_a_sentence():
    with pytest.raises(SimSettingsError, match="the controllers' parameters names no controllers"):
        Simulation(PENDULUM, controllers={"hinge_controller": {}})
    with pytest.raises(SimSettingsError, match="a xacro model is given by its file"):
        Simulation("<robot xmlns:xacro='http://www.ros.org/wiki/xacro'/>")
