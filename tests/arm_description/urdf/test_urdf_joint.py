"""<joint>: type, axis, limits, mimic and the errors with their lines."""

import math

import pytest

from arm_description import (
    Dynamics,
    Joint,
    JointLimit,
    JointType,
    Mimic,
    MimicCycleError,
    Pose,
    SafetyLimits,
    UrdfError,
    parse_urdf,
)

LINKS = "<parent link='a'/><child link='b'/>"
LIMIT = "<limit lower='-1' upper='2' effort='3' velocity='4'/>"


def text(inside: str, kind: str = "revolute", links: str = LINKS) -> str:
    return (
        "<robot name='r'><link name='a'/><link name='b'/>\n"
        f"<joint name='j' type='{kind}'>{links}\n{inside}</joint></robot>"
    )


def joint(inside: str, kind: str = "revolute") -> Joint:
    return parse_urdf(text(inside, kind)).joint("j")


def refusal(urdf: str) -> str:
    with pytest.raises(UrdfError) as caught:
        parse_urdf(urdf)
    return str(caught.value).removeprefix("robot_description, ")


def test_everything_that_a_joint_has():
    read = joint(
        f"<origin xyz='1 2 3' rpy='4 5 6'/><axis xyz='0 0 1'/>{LIMIT}"
        "<dynamics damping='0.1' friction='0.2'/><calibration rising='0'/>"
        "<safety_controller soft_lower_limit='-0.5' k_velocity='7'/>"
    )
    assert read == Joint(
        name="j",
        type="revolute",
        parent="a",
        child="b",
        origin=Pose((1, 2, 3), (4, 5, 6)),
        axis=(0, 0, 1),
        limit=JointLimit(-1, 2, 3, 4),
        dynamics=Dynamics(0.1, 0.2),
        mimic=None,
        safety=SafetyLimits(-0.5, math.inf, 0.0, 7.0),
        line=2,
    )


def test_what_is_not_given_has_urdfs_defaults():
    assert joint("", "continuous") == Joint("j", "continuous", "a", "b", line=2)
    assert joint("", "continuous").axis == (1.0, 0.0, 0.0)


def test_an_axis_is_made_a_unit_vector():
    assert joint("<axis xyz='0 3 -4'/>", "continuous").axis == pytest.approx((0, 0.6, -0.8))


@pytest.mark.parametrize("xyz", ["0 1e-200 0", "0 1e200 0"])
def test_an_axis_of_any_length_is_a_direction(xyz):
    assert joint(f"<axis xyz='{xyz}'/>", "continuous").axis == (0, 1, 0)


@pytest.mark.parametrize("kind", ["fixed", "floating"])
def test_an_axis_of_zeros_means_nothing_where_nothing_turns(kind):
    assert joint("<axis xyz='0 0 0'/>", kind).type == kind


def test_a_continuous_joint_has_no_bounds():
    assert joint(LIMIT, "continuous").limit == JointLimit(-math.inf, math.inf, 3, 4)


@pytest.mark.parametrize("kind", ["fixed", "floating", "planar"])
def test_a_limit_means_nothing_where_one_number_does_not_move_the_joint(kind):
    assert joint(LIMIT, kind).limit is None


def test_bounds_that_are_not_given_are_zero():
    assert joint("<limit effort='1' velocity='1'/>").limit == JointLimit(0, 0, 1, 1)


def test_a_mimic_with_defaults_and_without():
    links = "<link name='a'/><link name='b'/><link name='c'/>"
    leader = f"<joint name='k' type='continuous'>{LINKS}</joint>"
    follower = "<joint name='j' type='continuous'><parent link='b'/><child link='c'/>{}</joint>"
    for tag, expected in (
        ("<mimic joint='k'/>", Mimic("k", 1.0, 0.0)),
        ("<mimic joint='k' multiplier='-2' offset='0.5'/>", Mimic("k", -2.0, 0.5)),
    ):
        robot = parse_urdf(f"<robot name='r'>{links}{leader}{follower.format(tag)}</robot>")
        assert robot.joint("j").mimic == expected


@pytest.mark.parametrize(
    ("urdf", "message"),
    [
        (
            text("", "hinge"),
            "line 2: joint 'j' has type 'hinge'; the types are fixed, revolute, "
            "continuous, prismatic, floating, planar",
        ),
        (text("", ""), "line 2: joint 'j' needs the attribute 'type'"),
        (text(LIMIT, links="<child link='b'/>"), "line 2: joint 'j' needs a <parent>"),
        (text(LIMIT, links="<parent link='a'/>"), "line 2: joint 'j' needs a <child>"),
        (
            text(LIMIT, links="<parent/><child link='b'/>"),
            "line 2: <parent> of joint 'j' needs the attribute 'link'",
        ),
        (text(""), "line 2: joint 'j' is revolute and needs a <limit>"),
        (text("", "prismatic"), "line 2: joint 'j' is prismatic and needs a <limit>"),
        (
            text("<limit lower='-1' upper='1' velocity='1'/>"),
            "line 3: <limit> of joint 'j' needs the attribute 'effort'",
        ),
        (
            text("<limit lower='-1' upper='1' effort='1'/>"),
            "line 3: <limit> of joint 'j' needs the attribute 'velocity'",
        ),
        (
            text("<limit lower='-inf' upper='1' effort='1' velocity='1'/>"),
            "line 3: <limit> of joint 'j' has lower='-inf', which is not a finite number",
        ),
        (
            text("<axis xyz='0 0 0'/>" + LIMIT),
            "line 3: <axis> of joint 'j' is '0 0 0', which is not a direction",
        ),
        (
            text("<axis xyz='1 0'/>" + LIMIT),
            "line 3: <axis> of joint 'j' has xyz='1 0': 2 values, not 3",
        ),
        (text("<mimic/>" + LIMIT), "line 3: <mimic> of joint 'j' needs the attribute 'joint'"),
        (
            text("<dynamics damping='x'/>" + LIMIT),
            "line 3: <dynamics> of joint 'j' has damping='x', which is not a finite number",
        ),
    ],
)
def test_an_error_names_line_and_joint(urdf, message):
    assert refusal(urdf) == message


def test_joints_that_mimic_in_a_circle_are_refused():
    joints = "".join(
        f"\n<joint name='{name}' type='continuous'><parent link='{parent}'/><child link='{child}'/>"
        f"<mimic joint='{leader}'/></joint>"
        for name, parent, child, leader in (("j", "a", "b", "k"), ("k", "b", "c", "j"))
    )
    urdf = f"<robot name='r'><link name='a'/><link name='b'/><link name='c'/>{joints}</robot>"
    with pytest.raises(MimicCycleError, match=r"line 3: .*in a circle: j -> k -> j$"):
        parse_urdf(urdf)


def test_a_joint_that_mimics_itself_is_refused():
    with pytest.raises(MimicCycleError, match="j -> j"):
        joint("<mimic joint='j'/>" + LIMIT)


def test_every_type_that_has_one_position_either_turns_or_slides():
    assert all(kind.is_scalar == (kind.turns != kind.slides) for kind in JointType)
    assert not any(kind.turns and kind.slides for kind in JointType)


def test_a_joint_takes_its_type_by_name():
    assert Joint("j", "continuous", "a", "b").type is JointType.CONTINUOUS
