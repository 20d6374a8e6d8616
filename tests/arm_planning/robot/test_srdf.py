import pytest
from hypothesis import given
from hypothesis import strategies as st
from robots import joint, link, robot

from arm_description import parse_urdf
from arm_planning.errors import MoveItErrorCode, SrdfError
from arm_planning.robot.srdf import (
    EndEffector,
    Srdf,
    SrdfGroup,
    VirtualJoint,
    parse_srdf,
    srdf_text,
)
from arm_planning.scene.allowed_collisions import allowed_collisions

ARM = parse_urdf(
    robot(
        *(link(name) for name in ("base", "upper", "lower", "hand")),
        joint("shoulder", "base", "upper"),
        joint("elbow", "upper", "lower"),
        joint("wrist", "lower", "hand"),
        name="arm",
    )
)
ODD = "l<\"&'>"
XML = {"'": "&apos;", "<": "&lt;", '"': "&quot;", "&": "&amp;"}
ESCAPED = "".join(XML.get(letter, letter) for letter in ODD)
ROBOT = parse_urdf(
    robot(
        *(link(name) for name in ("a", "b", ESCAPED)),
        joint("i", "a", "b"),
        joint("j", "b", ESCAPED),
        joint("free", "a", "c", kind="floating", limits=None),
        link("c"),
    )
)
LINKS, JOINTS = st.sampled_from(["a", "b", ODD]), st.sampled_from(["i", "j"])
PAIRS = st.tuples(LINKS, LINKS).map(lambda pair: (min(pair), max(pair)))
NUMBERS = st.floats(allow_nan=False, allow_infinity=False)
GROUPS = st.builds(
    SrdfGroup,
    st.lists(JOINTS, max_size=2).map(tuple),
    st.lists(LINKS, max_size=2).map(tuple),
    st.lists(st.tuples(LINKS, LINKS), max_size=2).map(tuple),
)
SRDFS = st.builds(
    Srdf,
    st.sampled_from(["r", ODD]),
    groups=st.fixed_dictionaries({"g": GROUPS, ODD: st.just(SrdfGroup(subgroups=("g",)))}),
    states=st.dictionaries(
        st.tuples(st.sampled_from(["g", ODD]), st.sampled_from(["home", ODD])),
        st.fixed_dictionaries(
            {}, optional={"i": st.tuples(NUMBERS), "free": st.tuples(NUMBERS, NUMBERS)}
        ),
    ),
    end_effectors=st.dictionaries(
        st.just("e"), st.builds(EndEffector, LINKS, st.just("g"), st.sampled_from(["", ODD]))
    ),
    virtual_joints=st.sampled_from([(), (VirtualJoint("v", "planar", ODD, "a"),)]),
    passive_joints=st.lists(JOINTS, max_size=2).map(tuple),
    disabled=st.dictionaries(PAIRS, st.sampled_from(["Never", "", ODD])),
    enabled=st.lists(PAIRS, unique=True).map(tuple),
    touching=st.lists(LINKS, max_size=2).map(tuple),
    properties=st.dictionaries(st.tuples(JOINTS, st.just("p")), st.sampled_from(["1", ODD])),
)


def read(*lines: str, name: str = "arm") -> tuple[Srdf, list[str]]:
    remarks: list[str] = []
    text = "\n".join([f"<robot name='{name}'>", *lines, "</robot>"])
    return parse_srdf(text, ARM, "arm.srdf", lambda remark: remarks.append(str(remark))), remarks


def refusal(*lines: str) -> str:
    with pytest.raises(SrdfError) as caught:
        read(*lines)
    assert caught.value.code is MoveItErrorCode.FAILURE
    return str(caught.value)


def test_every_part_is_read():
    srdf, remarks = read(
        "<group name='arm'><joint name='shoulder'/><link name='lower'/>",
        "<chain base_link='base' tip_link='hand'/></group>",
        "<group name='all'><group name='arm'/></group>",
        "<group name='tool'><joint name='wrist'/></group>",
        "<group_state name='ready' group='arm'><joint name='elbow' value='1.5'/></group_state>",
        "<end_effector name='grip' parent_link='lower' group='tool' parent_group='arm'/>",
        "<virtual_joint name='v' type='planar' parent_frame='odom' child_link='base'/>",
        "<passive_joint name='wrist'/>",
        "<joint_property joint_name='wrist' property_name='speed' value='2'/>",
        "<disable_collisions link1='upper' link2='base' reason='Adjacent'/>",
        "<enable_collisions link1='hand' link2='base'/>",
        "<disable_default_collisions link='hand'/>",
    )
    assert not remarks
    assert srdf == Srdf(
        "arm",
        groups={
            "arm": SrdfGroup(("shoulder",), ("lower",), (("base", "hand"),)),
            "all": SrdfGroup(subgroups=("arm",)),
            "tool": SrdfGroup(("wrist",)),
        },
        states={("arm", "ready"): {"elbow": (1.5,)}},
        end_effectors={"grip": EndEffector("lower", "tool", "arm")},
        virtual_joints=(VirtualJoint("v", "planar", "odom", "base"),),
        passive_joints=("wrist",),
        disabled={("base", "upper"): "Adjacent"},
        enabled=(("base", "hand"),),
        touching=("hand",),
        properties={("wrist", "speed"): "2"},
    )


def test_another_robots_name_is_a_warning():
    srdf, remarks = read(name="leg")
    assert srdf.robot_name == "leg"
    assert remarks == ["line 1: <robot> is for the robot 'leg', but the URDF is of 'arm'"]


@pytest.mark.parametrize(
    ("line", "remark"),
    [
        (
            "<group name='g'><link name='hand'/><joint name='wrists'/></group>",
            "<joint> of group 'g' is left out: there is no joint 'wrists'; did you mean 'wrist'?",
        ),
        (
            "<group name='g'><link name='hand'/><chain base_link='x' tip_link='hand'/></group>",
            "<chain> of group 'g' is left out: there is no link 'x'; the robot has base, hand, "
            "lower, upper",
        ),
        (
            "<group name='g'><link name='hand'/><group name='x'/></group>",
            "<group> of group 'g' is left out: there is no group 'x'; the SRDF has g",
        ),
        ("<group name='g'/>", "group 'g' is empty, so nothing can be planned for it"),
        (
            "<group_state name='s' group='arms'/>",
            "group_state 's' is left out: there is no group 'arms'; the SRDF has none",
        ),
        (
            "<virtual_joint name='v' type='odd' parent_frame='w' child_link='base'/>",
            "virtual_joint 'v' has the type 'odd' and is fixed instead; there are fixed, planar, "
            "floating",
        ),
        (
            "<passive_joint name='knee'/>",
            "<passive_joint> is left out: there is no joint 'knee'; the robot has elbow, "
            "shoulder, wrist",
        ),
    ],
)
def test_what_does_not_exist_is_left_out_with_a_warning(line, remark):
    assert read(line)[1] == [f"line 2: {remark}"]


def test_one_warning_names_all_links_of_pairs_that_the_robot_lacks():
    srdf, remarks = read(
        *(f"<disable_collisions link1='finger{n}' link2='hand' reason='Never'/>" for n in "12"),
        "<disable_collisions link1='base' link2='hand' reason='Never'/>",
    )
    assert list(srdf.disabled) == [("base", "hand")]
    assert remarks == [
        "line 2: <disable_collisions> is left out: the robot does not have finger1, finger2"
    ]


@pytest.mark.parametrize(
    ("lines", "sentence"),
    [
        (["<group/>"], "arm.srdf, line 2: <group> needs the attribute 'name'"),
        (
            ["<group name='a'/>", "<group name='a'/>"],
            "arm.srdf, line 3: group 'a' is the second one; the first is in line 2",
        ),
        (
            [
                "<group name='a'><group name='b'/></group>",
                "<group name='b'><group name='a'/></group>",
            ],
            "arm.srdf, line 2: group 'a' contains itself: a -> b -> a",
        ),
        (
            [
                "<group name='a'/>",
                "<group_state name='s' group='a'>",
                "<joint name='wrist' value='nan'/>",
                "</group_state>",
            ],
            "arm.srdf, line 4: <joint> of group_state 's' has value='nan', which is not a finite "
            "number",
        ),
        (
            ["<group_state name='s' group='a'><joint name='wrist' value='1 2'/></group_state>"],
            "arm.srdf, line 2: <joint> of group_state 's' has 2 values for 'wrist', not 1",
        ),
        (
            ["<disable_collisions link1='hand'/>"],
            "arm.srdf, line 2: <disable_collisions> needs the attribute 'link2'",
        ),
    ],
)
def test_what_is_written_wrongly_is_refused(lines, sentence):
    assert refusal(*lines) == sentence


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("", "arm.srdf is empty"),
        ("<robot", "arm.srdf, line 1: not XML: Couldn't find end of Start Tag robot line 1"),
        (
            "<mujoco/>",
            "arm.srdf, line 1: <mujoco> is not an SRDF; its outermost element is <robot>",
        ),
    ],
)
def test_a_text_that_is_not_an_srdf_is_refused(text, sentence):
    with pytest.raises(SrdfError) as caught:
        parse_srdf(text, ARM, "arm.srdf")
    assert str(caught.value) == sentence


def test_disabled_pairs_win_over_enabled_ones_and_those_over_links_that_may_touch_everything():
    allowed = allowed_collisions(
        read(
            "<disable_default_collisions link='hand'/>",
            "<enable_collisions link1='hand' link2='base'/>",
            "<enable_collisions link1='hand' link2='upper'/>",
            "<disable_collisions link1='upper' link2='hand' reason='User'/>",
        )[0]
    )
    touching = [other for other in ("base", "upper", "lower") if allowed.may_touch(other, "hand")]
    assert touching == ["upper", "lower"]
    assert not allowed.may_touch("base", "upper")


@given(SRDFS)
def test_what_is_written_is_read_again(srdf):
    assert parse_srdf(srdf_text(srdf), ROBOT, remark=lambda _: None) == srdf
