import math

import pytest
from robots import joint, link, robot

from arm_description import parse_urdf
from arm_planning.errors import PlanningError
from arm_planning.robot.build import planning_model
from arm_planning.robot.limits import GivenLimits, JointLimitSettings
from arm_planning.robot.model import PlanningModel
from arm_planning.robot.srdf import parse_srdf

LINKS = ("base", "upper", "lower", "flange", "hand", "finger", "thumb", "camera")
ROBOT = parse_urdf(
    robot(
        *(link(name) for name in LINKS),
        joint("elbow", "upper", "lower"),
        joint("shoulder", "base", "upper", kind="continuous", limits=None),
        joint("wrist", "lower", "flange", velocity=2.0),
        joint("mount", "flange", "hand", kind="fixed", limits=None),
        joint("grip", "hand", "finger"),
        joint("follow", "hand", "thumb", "<mimic joint='grip' multiplier='-1'/>"),
        joint("pan", "base", "camera"),
    )
)
CHAIN = "<group name='g'><chain base_link='base' tip_link='hand'/></group>"


def model(*lines: str, limits: JointLimitSettings | None = None) -> PlanningModel:
    srdf = parse_srdf(f"<robot name='r'>{''.join(lines)}</robot>", ROBOT, remark=print)
    return planning_model(ROBOT, srdf, limits, warn=print)


def test_the_active_joints_are_in_tree_order():
    assert model().joints == ("shoulder", "elbow", "wrist", "grip", "pan")


def test_a_chain_ends_at_its_last_link():
    group = model(CHAIN).group("g")
    assert group.joints == ("shoulder", "elbow", "wrist")
    assert (group.base, group.tip) == ("base", "hand")
    assert group.links == ("upper", "lower", "flange", "hand")
    assert group.continuous == (True, False, False)
    assert [limit.velocity for limit in group.limits] == [3.0, 3.0, 2.0]


def test_joints_that_follow_each_other_are_a_chain_whatever_their_order():
    group = model(
        "<group name='g'><joint name='grip'/><joint name='wrist'/><joint name='elbow'/></group>"
    ).group("g")
    assert (group.base, group.tip) == ("upper", "finger")


@pytest.mark.parametrize(
    "joints", [("shoulder", "wrist"), ("elbow", "pan"), ("grip", "follow"), ()]
)
def test_other_joints_are_no_chain(joints):
    parts = "".join(f"<joint name='{name}'/>" for name in joints)
    group = model(f"<group name='g'>{parts}</group>").group("g")
    assert (group.base, group.tip) == ("", "")


def test_a_link_stands_for_the_joint_that_carries_it():
    group = model("<group name='g'><link name='base'/><link name='lower'/></group>").group("g")
    assert group.joints == ("elbow",)


def test_a_group_has_the_joints_of_its_subgroups():
    groups = model(
        "<group name='a'><joint name='elbow'/></group><group name='b'><group name='a'/></group>",
        "<group name='c'><group name='b'/><joint name='grip'/></group>",
    )
    assert groups.group("c").joints == ("elbow", "grip")


def test_a_chain_from_tip_to_tip_goes_down_and_up():
    group = model("<group name='g'><chain base_link='camera' tip_link='lower'/></group>").group("g")
    assert group.joints == ("shoulder", "elbow", "pan")
    assert group.tip == ""


def test_mimic_joints_are_not_active():
    group = model(
        "<group name='g'><joint name='grip'/><joint name='follow'/></group>",
        "<group_state name='s' group='g'><joint name='grip' value='1'/>",
        "<joint name='follow' value='-1'/></group_state>",
    )
    assert group.group("g").joints == ("grip",)
    assert group.group("g").links == ("finger", "thumb")
    assert group.states["g", "s"] == {"grip": 1.0}


@pytest.mark.parametrize(
    ("kind", "child", "frame"),
    [("floating", "base", "odom"), ("fixed", "base", "base"), ("planar", "hand", "base")],
)
def test_only_a_virtual_joint_that_moves_the_root_gives_the_frame(kind, child, frame):
    joints = f"<virtual_joint name='v' type='{kind}' parent_frame='odom' child_link='{child}'/>"
    assert model(joints).frame == frame


def test_a_continuous_joint_with_given_limits_ends():
    limits = JointLimitSettings({"shoulder": GivenLimits(min_position=-1.0, max_position=2.0)})
    group = model(CHAIN, limits=limits).group("g")
    assert group.continuous == (False, False, False)
    assert (group.limits[0].lower, group.limits[0].upper) == (-1.0, 2.0)


def test_a_turning_joint_without_limits_is_continuous():
    limits = JointLimitSettings({"elbow": GivenLimits(has_position_limits=False)})
    group = model(CHAIN, limits=limits).group("g")
    assert group.continuous == (True, True, False)
    assert group.limits[1].upper == math.inf


def test_limits_of_joints_that_do_not_exist_are_a_warning(capsys):
    model(limits=JointLimitSettings({"knee": GivenLimits()}))
    sentence = "joint_limits are given for joints that the robot does not have: knee\n"
    assert sentence in capsys.readouterr().out


def test_an_unknown_group_names_those_that_exist():
    with pytest.raises(PlanningError, match="no group 'x'; the robot has g"):
        model(CHAIN).group("x")
