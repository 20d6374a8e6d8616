"""The parameters of MoveIt's trajectory execution, and those of its controllers."""

import pytest

from arm_planning.errors import PlanningError
from arm_planning.execution.controllers import controllers_of_settings
from arm_planning.execution.settings import ExecutionSettings

CONTROLLER = {
    "controller_names": ["hand"],
    "hand.type": "GripperCommand",
    "hand.joints": ["finger"],
}


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
def test_what_cannot_be_used_is_refused(name: str, value: object, says: str):
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
def test_what_a_controller_cannot_use_is_refused(name: str, value: object, says: str):
    with pytest.raises(PlanningError, match=says):
        controllers_of_settings({**CONTROLLER, name: value})
