"""The files that motion planning reads fit the robot, its joints and its controllers."""

from functools import cache
from typing import Any

import pytest

from arm_description import expand_xacro, parse_urdf, resolve_uri
from arm_node.limited_yaml import load_yaml
from arm_node.parameter_file import flat_parameters
from arm_planning.execution import choose_controllers, controllers_of_settings
from arm_planning.robot.build import planning_model
from arm_planning.robot.limits import read_joint_limits
from arm_planning.robot.model import PlanningLimits, PlanningModel
from arm_planning.robot.srdf import Srdf, parse_srdf

FOLDER = "package://mycobot_moveit_config/config/mycobot_280"
URDF = "package://mycobot_description/urdf/robots/mycobot_280.urdf.xacro"


def text(name: str) -> str:
    return resolve_uri(f"{FOLDER}/{name}").read_text()


@cache
def files(**arguments: str) -> tuple[PlanningModel, Srdf, tuple[str, ...]]:
    remarks: list[str] = []
    robot = parse_urdf(expand_xacro(resolve_uri(URDF), arguments))
    srdf = parse_srdf(text("mycobot_280.srdf"), robot, remark=lambda r: remarks.append(str(r)))
    limits = read_joint_limits(text("joint_limits.yaml"), "joint_limits.yaml", remarks.append)
    return planning_model(robot, srdf, limits, remarks.append), srdf, tuple(remarks)


def content(name: str) -> dict[str, Any]:
    return load_yaml(text(name))


def test_all_that_they_name_exists():
    assert not files()[2]


def test_the_arm_ends_at_its_gripper():
    arm = files()[0].group("arm")
    assert (arm.base, arm.tip, len(arm.joints)) == ("link1", "gripper_base", 6)


def test_the_groups_share_the_joints():
    model = files()[0]
    assert model.group("gripper").joints == ("gripper_controller",)
    assert model.group("arm_with_gripper").joints == model.joints


@pytest.mark.parametrize("name", ["arm", "gripper", "arm_with_gripper"])
def test_named_states_give_each_joint_a_position_within_its_limits(name):
    model = files()[0]
    group = model.group(name)
    states = [state for (owner, _), state in model.states.items() if owner == name]
    assert len(states) >= 2
    for state in states:
        positions = group.positions(state)
        assert ((group.lower <= positions) & (positions <= group.upper)).all()


def test_the_limits_are_those_of_the_file():
    limits = files()[0].group("arm").limits[0]
    assert limits == PlanningLimits(-2.879793, 2.879793, 2.792527, 5.0)


def test_without_the_gripper_the_arm_remains():
    model, _, remarks = files(use_gripper="false")
    assert model.group("arm").joints == files()[0].group("arm").joints
    assert model.group("arm").tip == "link6_flange"
    assert any("no joint 'gripper_controller'" in remark for remark in remarks)


def test_the_controllers_drive_all_joints():
    settings = content("moveit_controllers.yaml")["moveit_simple_controller_manager"]
    controllers = controllers_of_settings(dict(flat_parameters(settings)))
    chosen = choose_controllers(controllers, files()[0].joints)
    assert [each.action_name for each in chosen] == [
        "arm_controller/follow_joint_trajectory",
        "gripper_action_controller/gripper_cmd",
    ]


def test_each_group_has_its_kinematics():
    assert content("kinematics.yaml").keys() == files()[0].groups.keys()


def test_lin_and_circ_have_their_limits():
    assert content("pilz_cartesian_limits.yaml")["cartesian_limits"].keys() == {
        "max_trans_vel",
        "max_trans_acc",
        "max_trans_dec",
        "max_rot_vel",
    }
