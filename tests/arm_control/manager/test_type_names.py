"""Which unknown types of controllers are the user's mistake."""

import pytest

from arm_control.manager.registry import controller_types
from arm_control.manager.type_names import ONLY_IN_CPP, is_misspelt, near_types, unknown_type

KNOWN = controller_types()


@pytest.mark.parametrize("known", KNOWN)
def test_each_known_type_with_a_slip_of_the_keyboard_is_misspelt(known):
    package, _, name = known.partition("/")
    for slip in (f"{known}r", f"{package}s/{name}", f"{package}/{name[:-1]}", known.lower()):
        if slip not in KNOWN:
            assert is_misspelt(slip, KNOWN), slip
            assert known in near_types(slip, KNOWN), slip


@pytest.mark.parametrize(
    "type_name",
    [
        *sorted(ONLY_IN_CPP),
        "ur_controllers/ScaledJointTrajectoryController",
        "franka_example_controllers/JointImpedanceExampleController",
        "my_robot::control/my_robot::control::ArmController",
    ],
)
def test_a_type_of_a_package_that_is_missing_is_not(type_name):
    assert type_name not in KNOWN
    assert not is_misspelt(type_name, KNOWN)


@pytest.mark.parametrize(
    "type_name",
    ["", "JointTrajectoryController", "a b/C", "a/", "/C", "joint_trajectory_controller/Joints"],
)
def test_what_names_no_plugin_or_no_class_of_a_known_package_is_misspelt(type_name):
    assert is_misspelt(type_name, KNOWN)


def test_the_sentence_has_the_near_names_or_else_all():
    slip = "joint_trajectory_controller/JointTrajectoryControler"
    assert unknown_type(slip, KNOWN) == (
        f"no controller type '{slip}'; did you mean "
        "'joint_trajectory_controller/JointTrajectoryController'?"
    )
    assert near_types("JointTrajectoryController", KNOWN) == (
        "joint_trajectory_controller/JointTrajectoryController",
    )
    assert near_types("pid_controller/Pid", KNOWN) == ("pid_controller/PidController",)
    assert unknown_type("x/Y", {"a/B", "c/D"}) == "no controller type 'x/Y'; known: a/B, c/D"
