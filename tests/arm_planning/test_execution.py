"""Which controllers run a trajectory."""

import numpy as np
import pytest

from arm_planning.errors import MoveItErrorCode, PlanningError
from arm_planning.execution import (
    ControllerKind,
    ExecutionSettings,
    TrajectoryController,
    choose_controllers,
    controllers_of_settings,
    part_for,
)
from arm_planning.trajectory import TimedTrajectory

SETTINGS = {
    "controller_names": ["arm", "hand"],
    "arm.type": "FollowJointTrajectory",
    "arm.action_ns": "follow_joint_trajectory",
    "arm.joints": ["j1", "j2"],
    "arm.default": True,
    "hand.type": "GripperCommand",
    "hand.action_ns": "gripper_cmd",
    "hand.joints": ["finger"],
    "hand.max_effort": 3,
}
CONTROLLER = {
    "controller_names": ["hand"],
    "hand.type": "GripperCommand",
    "hand.joints": ["finger"],
}


def controller(name: str, *joints: str, default: bool = False) -> TrajectoryController:
    kind = ControllerKind.FOLLOW_JOINT_TRAJECTORY
    return TrajectoryController(name, "follow_joint_trajectory", kind, joints, default)


def chosen(controllers, joints, names=()) -> list[str]:
    return [each.name for each in choose_controllers(controllers, joints, names)]


def test_settings_have_moveits_names():
    arm, hand = controllers_of_settings(SETTINGS)
    assert arm.action_name == "arm/follow_joint_trajectory"
    assert (arm.joints, arm.is_default) == (("j1", "j2"), True)
    assert (hand.kind, hand.max_effort) == (ControllerKind.GRIPPER_COMMAND, 3.0)


@pytest.mark.parametrize(
    ("changed", "problem"),
    [
        ({"arm.type": "Follow"}, "has the type 'Follow'; there are FollowJointTrajectory"),
        ({"arm.joints": []}, "'arm' of moveit_simple_controller_manager has no joints"),
        ({"controller_names": 3}, "is not a list of names"),
    ],
)
def test_settings_that_cannot_be_used_are_named(changed, problem):
    with pytest.raises(PlanningError, match=problem):
        controllers_of_settings({**SETTINGS, **changed})


def test_the_fewest_controllers_are_chosen_and_defaults_first():
    both = controller("both", "j1", "j2", "finger")
    parts = [controller("arm", "j1", "j2"), controller("hand", "finger")]
    assert chosen([*parts, both], ["j1", "finger"]) == ["both"]
    assert chosen(parts, ["j1", "finger"]) == ["arm", "hand"]
    twin = controller("twin", "j1", "j2", default=True)
    assert chosen([*parts, twin], ["j1"]) == ["twin"]


def test_two_controllers_of_one_joint_are_never_chosen_together():
    overlapping = [controller("a", "j1", "j2"), controller("b", "j2", "j3")]
    with pytest.raises(PlanningError, match="Unable to identify any set of controllers"):
        choose_controllers(overlapping, ["j1", "j3"])


def test_a_named_controller_is_used_and_an_unknown_one_is_refused():
    parts = [controller("arm", "j1"), controller("other", "j1")]
    assert chosen(parts, ["j1"], ["other"]) == ["other"]
    with pytest.raises(PlanningError, match="Controller othre is not known; did you mean 'other'"):
        choose_controllers(parts, ["j1"], ["othre"])


def test_what_nobody_drives_is_named():
    with pytest.raises(PlanningError, match="no active controller drives j9") as error:
        choose_controllers([controller("arm", "j1")], ["j1", "j9"])
    assert error.value.code is MoveItErrorCode.CONTROL_FAILED
    assert "arm (j1)" in str(error.value)


def test_each_controller_gets_its_columns():
    times = np.array([0.0, 1.0])
    values = np.arange(6.0).reshape(2, 3)
    whole = TimedTrajectory(("j1", "finger", "j2"), times, values, values, values)
    part = part_for(whole, controller("arm", "j2", "j1"))
    assert part.joints == ("j1", "j2")
    assert part.positions.tolist() == [[0.0, 2.0], [3.0, 5.0]]


def test_parameters_replace_the_defaults_one_by_one():
    given = {"allowed_start_tolerance": 0, "execution_duration_monitoring": False}
    found = ExecutionSettings.read(given)
    assert found == ExecutionSettings(start_tolerance=0.0, monitors_duration=False)


@pytest.mark.parametrize(
    ("name", "value", "says"),
    [
        ("allowed_start_tolerance", "0.01", "is '0.01', which is not a finite number"),
        ("allowed_goal_duration_margin", -1.0, "is -1.0; it is at least 0"),
        ("allowed_execution_duration_scaling", True, "is True, which is not a finite number"),
        ("execution_duration_monitoring", "false", "is 'false'; it is true or false"),
    ],
)
def test_what_cannot_be_used_is_refused(name, value, says):
    with pytest.raises(PlanningError) as caught:
        ExecutionSettings.read({name: value})
    assert str(caught.value) == f"trajectory_execution.{name} {says}"


@pytest.mark.parametrize(
    ("name", "value", "says"),
    [
        ("hand.max_effort", "3", "hand.max_effort is '3', which is not a finite number"),
        ("hand.default", 1, "hand.default is 1; it is true or false"),
        ("hand.allow_failure", "yes", "hand.allow_failure is 'yes'; it is true or false"),
        ("hand.allowed_goal_duration_margin", -1, "margin is -1; it is at least 0"),
        ("controller_names", "hand", "controller_names is not a list of names"),
    ],
)
def test_what_a_controller_cannot_use_is_refused(name, value, says):
    with pytest.raises(PlanningError, match=says):
        controllers_of_settings({**CONTROLLER, name: value})
