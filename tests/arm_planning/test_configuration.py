"""The folder of a MoveIt configuration becomes move_group's parameters."""

import pytest

from arm_planning.configuration import move_group_parameters, servo_parameters
from arm_planning.errors import PlanningError


def test_each_file_has_its_parameter(tmp_path):
    config = tmp_path / "config"
    config.mkdir()
    (config / "r.srdf").write_text("<robot name='r'/>")
    (config / "kinematics.yaml").write_text("arm: {kinematics_solver_timeout: 0.1}")
    (config / "joint_limits.yaml").write_text("joint_limits: {j: {max_velocity: 1.0}}")
    (config / "pilz_cartesian_limits.yaml").write_text("cartesian_limits: {max_trans_vel: 1.0}")
    (config / "moveit_controllers.yaml").write_text("trajectory_execution: {a: 1}")
    (config / "ompl_planning.yaml").write_text("planner_configs: {}")
    assert move_group_parameters(tmp_path) == {
        "robot_description_semantic": "<robot name='r'/>",
        "robot_description_kinematics": {"arm": {"kinematics_solver_timeout": 0.1}},
        "robot_description_planning": {
            "joint_limits": {"j": {"max_velocity": 1.0}},
            "cartesian_limits": {"max_trans_vel": 1.0},
        },
        "trajectory_execution": {"a": 1},
        "ompl": {"planner_configs": {}},
    }


def test_the_level_of_ros2_run_is_taken_off(tmp_path):
    text = "/**: {ros__parameters: {arm: {kinematics_solver: x}}}"
    (tmp_path / "kinematics.yaml").write_text(text)
    found = move_group_parameters(tmp_path)
    assert found == {"robot_description_kinematics": {"arm": {"kinematics_solver": "x"}}}


@pytest.mark.parametrize(
    ("files", "words"),
    [
        ({}, "has no MoveIt configuration"),
        ({"a.srdf": "", "b.srdf": ""}, "several SRDFs: a.srdf, b.srdf"),
        ({"kinematics.yaml": "[1, 2]"}, "kinematics.yaml is not a mapping"),
        ({"joint_limits.yaml": "a: [1"}, "joint_limits.yaml"),
    ],
)
def test_a_folder_that_cannot_be_used_is_named(tmp_path, files, words):
    for name, text in files.items():
        (tmp_path / name).write_text(text)
    with pytest.raises(PlanningError, match=words):
        move_group_parameters(tmp_path)


@pytest.mark.parametrize(
    "text",
    [
        "moveit_servo: {scale: {linear: 0.1}}",
        "scale: {linear: 0.1}",
        "/**: {ros__parameters: {moveit_servo: {scale: {linear: 0.1}}}}",
    ],
)
def test_a_file_of_moveit_servo_is_read_with_and_without_its_name(tmp_path, text):
    file = tmp_path / "servo.yaml"
    file.write_text(text)
    assert servo_parameters(file) == {"moveit_servo": {"scale": {"linear": 0.1}}}


def test_a_file_of_moveit_servo_that_is_missing_or_broken_is_named(tmp_path):
    with pytest.raises(PlanningError, match=r"there is no file .*servo\.yaml"):
        servo_parameters(tmp_path / "servo.yaml")
    (tmp_path / "list.yaml").write_text("[1, 2]")
    with pytest.raises(PlanningError, match=r"list\.yaml is not a mapping"):
        servo_parameters(tmp_path / "list.yaml")
