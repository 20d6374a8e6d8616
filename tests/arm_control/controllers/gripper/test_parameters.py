"""Names, types, defaults and rules of the parameters, as a real controller has them."""

import pytest

from arm_control.controllers.gripper.parameters import EffortGripperParameters
from arm_control.errors import ParameterError
from arm_control.manager.registry import controller_class
from arm_control.parameters import build_parameters, specs_of

COMMON = {
    "action_monitor_rate": (20.0, False),
    "allow_stalling": (False, False),
    "goal_tolerance": (0.01, False),
    "joint": ("", False),
    "max_effort": (0.0, False),
    "stall_timeout": (1.0, False),
    "stall_velocity_threshold": (0.001, False),
}
GAINS = {f"gains.grip.{name}": (0.0, False) for name in ("p", "i", "d", "i_clamp")}
# Read-only, unlike a real one's: a controller has the gains of the joint that it was loaded with.
EFFORT = {**COMMON, **GAINS, "joint": ("", True)}
# One more than a real one: so that max_effort can have an effect.
POSITION = {**COMMON, "max_effort_interface": ("", True)}
PARALLEL = {
    **COMMON,
    "action_monitor_rate": (20.0, True),
    "joint": ("", True),
    "max_effort": (10.0, False),
    "max_effort_interface": ("", False),
    "max_velocity": (0.1, False),
    "max_velocity_interface": ("", False),
    "state_interfaces": (("position", "velocity"), False),
}


@pytest.mark.parametrize(
    ("type_name", "expected"),
    [
        ("position_controllers/GripperActionController", POSITION),
        ("effort_controllers/GripperActionController", EFFORT),
        ("parallel_gripper_action_controller/GripperActionController", PARALLEL),
    ],
)
def test_they_are_those_of_a_real_one(type_name, expected):
    specs = controller_class(type_name).parameter_specs({"joint": "grip"})
    assert {spec.name: (spec.default, spec.read_only) for spec in specs} == expected


def test_without_a_joint_there_are_no_gains():
    assert {spec.name for spec in specs_of(EffortGripperParameters, given={})} == set(COMMON)


def test_gains_are_those_of_the_joint():
    parameters = build_parameters(EffortGripperParameters, {"joint": "grip", "gains.grip.p": 3})
    assert (parameters.joint, parameters.pid_gains.p) == ("grip", 3.0)
    assert (parameters.pid_gains.i_max, parameters.pid_gains.i_min) == (0.0, -0.0)


def test_gains_of_another_joint_are_unknown():
    with pytest.raises(ParameterError, match=r"unknown parameter gains\.j0\.p"):
        build_parameters(EffortGripperParameters, {"joint": "grip", "gains.j0.p": 3.0})
