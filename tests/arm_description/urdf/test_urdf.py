"""URDF as a whole: ignored elements, the tree's errors with their lines, and any input."""

import re

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from arm_description import (
    DescriptionError,
    JointLimit,
    Robot,
    UrdfError,
    XmlError,
    parse_urdf,
    parse_xml,
)
from arm_description.urdf.element import Remark

TWO_LINKS = "<link name='a'/>\n<link name='b'/>\n"


def joint(name: str, parent: str, child: str, inside: str = "") -> str:
    return (
        f"<joint name='{name}' type='continuous'><parent link='{parent}'/>"
        f"<child link='{child}'/>{inside}</joint>\n"
    )


def refusal(text: str) -> str:
    with pytest.raises(UrdfError) as caught:
        parse_urdf(text, "arm.urdf")
    return str(caught.value)


def test_names_and_lines_are_kept_in_the_documents_order():
    robot = parse_urdf(f"<robot name='r'>\n{TWO_LINKS}{joint('j', 'a', 'b')}</robot>")
    assert robot.name == "r"
    assert [(link.name, link.line) for link in robot.links] == [("a", 2), ("b", 3)]
    assert [(j.name, j.line) for j in robot.joints] == [("j", 4)]
    assert robot.root == "a"


def test_elements_of_others_and_unknown_ones_are_ignored():
    robot = parse_urdf(
        """<robot name='r' xmlns:x='http://www.ros.org/wiki/xacro' xmlns:y='y' version='1.0'>
             text
             <gazebo reference='nowhere'><sensor type='camera'/></gazebo>
             <ros2_control name='x'><joint name='j9'/></ros2_control>
             <transmission name='t'/> <x:macro/> <x:link/> <y:joint/> <anything><joint/></anything>
             <link name='a' new='1'><self_collision_checking/> <sensor/></link>
           </robot>"""
    )
    assert [link.name for link in robot.links] == ["a"]
    assert robot.joints == ()


def test_elements_in_a_namespace_are_read():
    robot = parse_urdf("<robot name='r' xmlns='http://www.ros.org'><link name='a'/></robot>")
    assert robot.root == "a"


def test_text_that_is_not_xml_is_an_xml_error():
    with pytest.raises(XmlError, match=r"^arm\.urdf, line 1: "):
        parse_urdf("not a robot", "arm.urdf")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "\n<sdf version='1.6'/>",
            "arm.urdf, line 2: <sdf> is not a robot; a URDF's outermost element is <robot>. SDF is "
            "a world or a model: world:=FILE, or arm sim spawn FILE",
        ),
        ("<robot>\n</robot>", "arm.urdf, line 1: <robot> needs the attribute 'name'"),
        ("<robot name='r'/>", "arm.urdf, the robot has no links"),
        (
            "<robot name='r'>\n<link/></robot>",
            "arm.urdf, line 2: <link> needs the attribute 'name'",
        ),
        (
            "<robot name='r'>\n<link name=' '/></robot>",
            "arm.urdf, line 2: <link> needs the attribute 'name'",
        ),
        (
            "<robot name='r'><link name='a'/>\n<link name='a'/></robot>",
            "arm.urdf, line 2: a second link 'a'; the first is in line 1",
        ),
        (
            f"<robot name='r'>{TWO_LINKS}<link name='c'/>\n"
            f"{joint('j', 'a', 'b')}{joint('j', 'b', 'c')}</robot>",
            "arm.urdf, line 5: a second joint 'j'; the first is in line 4",
        ),
        (
            f"<robot name='r'>\n{TWO_LINKS}</robot>",
            "arm.urdf, a robot has one root link, but these links have no parent joint: "
            "'a' (line 2), 'b' (line 3)",
        ),
        (
            f"<robot name='r'>\n{TWO_LINKS}{joint('j', 'x', 'b')}</robot>",
            "arm.urdf, line 4: joint 'j' has the parent link 'x', which does not exist; "
            "the robot has a, b",
        ),
        (
            f"<robot name='r'>\n{TWO_LINKS}{joint('j', 'a', 'x')}</robot>",
            "arm.urdf, line 4: joint 'j' has the child link 'x', which does not exist; "
            "the robot has a, b",
        ),
        (
            f"<robot name='r'>\n{TWO_LINKS}{joint('j', 'a', 'b')}{joint('k', 'a', 'b')}</robot>",
            "arm.urdf, line 5: link 'b' is the child of joint 'k' and of joint 'j'; "
            "a link has one parent",
        ),
        (
            f"<robot name='r'>\n{TWO_LINKS}{joint('j', 'a', 'b')}{joint('k', 'b', 'a')}</robot>",
            "arm.urdf, line 5: links are each other's parents in a circle: a -> b -> a",
        ),
        (
            f"<robot name='r'>\n{TWO_LINKS}<link name='c'/>{joint('j', 'b', 'b')}"
            f"{joint('k', 'a', 'c')}</robot>",
            "arm.urdf, line 4: links are each other's parents in a circle: b -> b",
        ),
    ],
)
def test_an_error_names_source_line_and_what_exists(text, message):
    assert refusal(text) == message


def test_a_mimic_of_an_unknown_joint_moves_by_itself():
    inside = "<mimic joint='x'/>"
    remarks: list[Remark] = []
    robot = parse_urdf(
        f"<robot name='r'>\n{TWO_LINKS}{joint('j', 'a', 'b', inside)}</robot>",
        remark=remarks.append,
    )
    assert robot.joint("j").mimic is None
    assert list(map(str, remarks)) == [
        "line 4: joint 'j' mimics joint 'x', which does not exist; it moves by itself. "
        "The robot has j"
    ]


def test_many_names_are_cut_short():
    links = "".join(f"<link name='l{n}'/>" for n in range(500))
    message = refusal(f"<robot name='r'>{links}{joint('j', 'x', 'l0')}</robot>")
    assert message.endswith("l39 and 460 more")


def test_a_chain_of_ten_thousand_links_is_read_at_once():
    count = 10_000
    links = "".join(f"<link name='l{n}'/>" for n in reversed(range(count)))
    joints = "".join(joint(f"j{n}", f"l{n - 1}", f"l{n}") for n in range(1, count))
    robot = parse_urdf(f"<robot name='r'>{links}{joints}</robot>")
    assert robot.root == "l0"
    assert robot.joints_in_tree_order[-1].name == f"j{count - 1}"


WHOLE = """<robot name="r">
<material name="red"><color rgba="1 0 0 1"/></material>
<link name="a"><inertial><origin xyz="0 0 0"/><mass value="1"/>
<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
<link name="b"><visual name="v"><geometry><mesh filename="m.stl" scale="1 1 1"/></geometry>
<material name="red"/></visual>
<collision><geometry><capsule radius="1" length="2"/></geometry></collision></link>
<link name="c"><collision><geometry><box size="1 2 3"/></geometry></collision></link>
<joint name="j" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/>
<limit lower="-1" upper="1" effort="2" velocity="3"/><dynamics damping="1" friction="0"/>
<safety_controller soft_lower_limit="-1" soft_upper_limit="1" k_position="1" k_velocity="1"/>
</joint>
<joint name="k" type="prismatic"><parent link="b"/><child link="c"/><origin rpy="1 2 3"/>
<limit lower="-1" upper="1" effort="2" velocity="3"/><mimic joint="j" multiplier="1" offset="0"/>
</joint></robot>"""
WORDS = re.findall(r"[^<>\s\"=/]+|.", WHOLE, re.DOTALL)
OTHER_WORDS = st.one_of(
    st.sampled_from(WORDS),
    st.sampled_from(["nan", "-1", "1e999", "1 2", "", "0", "0 0 0", "x", "\n", "\x00", "&lt;"]),
    st.text(max_size=4),
)


@settings(deadline=None, max_examples=500)
@given(st.dictionaries(st.integers(0, len(WORDS) - 1), OTHER_WORDS, min_size=1, max_size=3))
def test_a_urdf_with_any_words_replaced_is_a_robot_or_a_description_error(replacements):
    text = "".join(replacements.get(i, word) for i, word in enumerate(WORDS))
    try:
        robot = parse_urdf(text)
    except DescriptionError:
        return
    assert {j.child for j in robot.joints} | {robot.root} == {x.name for x in robot.links}


def test_the_whole_urdf_is_a_robot():
    assert [joint.name for joint in parse_urdf(WHOLE).joints] == ["j", "k"]


@settings(deadline=None)
@given(st.one_of(st.text(), st.text("<>/='\" robtlink&;!-[]?\n")))
def test_any_text_is_a_description_error(text):
    with pytest.raises(DescriptionError):
        parse_urdf(text)


def remarks(text: str) -> tuple[Robot, list[str]]:
    told: list[str] = []
    robot = parse_urdf(text, remark=lambda remark: told.append(str(remark)))
    return robot, told


@pytest.mark.parametrize(
    ("inside", "told"),
    [
        (
            "<xacro:property name='x' value='1'/>\n<xacro:arm/><xacro:property name='y'/>",
            [
                "line 4: <xacro:property> was not expanded by xacro (and 1 more); it is ignored",
                "line 5: <xacro:arm> was not expanded by xacro; it is ignored",
            ],
        ),
        (
            "<drake:joint name='j'/><gazebo><ns:a ns:b='1' other:c='2'/></gazebo>",
            [
                "line 4: <drake:joint> has a prefix that is not declared; it is ignored",
                "line 4: <ns:a> has a prefix that is not declared; it is ignored",
            ],
        ),
        (
            "<link name='c'><visual><geometry><box size='1 1 1'/><sphere radius='1'/></geometry>"
            "</visual></link>" + joint("k", "b", "c"),
            ["line 4: <geometry> of link 'c' has 2 shapes; the first one is used, <box>"],
        ),
    ],
)
def test_what_ros_accepts_is_accepted_with_a_remark(inside, told):
    comment = "<?xml version='1.0'?><!-- <robot name='none'> -->"
    text = f"{comment}<robot name='r'>\n{TWO_LINKS}{inside}{joint('j', 'a', 'b')}</robot>"
    robot, said = remarks(text)
    assert {j.name for j in robot.joints} >= {"j"}
    assert said == told


@pytest.mark.parametrize(
    ("limit", "expected", "told"),
    [
        ("lower='2' upper='-1'", (-1.0, 2.0, 3.0, 4.0), "lower=2 above upper=-1; they are swapped"),
        ("effort='-1'", (0.0, 0.0, 0.0, 4.0), "effort=-1; a negative number sets no limit"),
        ("velocity='-2'", (0.0, 0.0, 3.0, 0.0), "velocity=-2; a negative number sets no"),
    ],
)
def test_limits_that_ros_accepts_are_accepted_with_a_remark(limit, expected, told):
    given = "".join(
        f" {key}='{n}'" for key, n in (("effort", 3), ("velocity", 4)) if key not in limit
    )
    hinge = joint("j", "a", "b", f"<limit {limit}{given}/>").replace("continuous", "revolute")
    robot, said = remarks(f"<robot name='r'>{TWO_LINKS}{hinge}</robot>")
    assert robot.joint("j").limit == JointLimit(*expected)
    assert len(said) == 1
    assert f"<limit> of joint 'j' has {told}" in said[0]


def test_a_robot_wrapped_in_urdf_is_read_with_its_lines():
    text = f"<urdf>\n<robot name='r'>\n{TWO_LINKS}{joint('j', 'a', 'b')}</robot></urdf>"
    robot, said = remarks(text)
    assert [link.line for link in robot.links] == [3, 4]
    assert said == [
        "line 2: <robot> is inside a <urdf>, which ROS's own parser does not accept; it is read "
        "anyway"
    ]
    assert parse_xml(text).tag == "robot"


@pytest.mark.parametrize("text", ["<urdf/>", "<urdf><robot/><robot/></urdf>", "<urdf><a/></urdf>"])
def test_any_other_urdf_element_is_not_a_robot(text):
    assert "is not a robot" in refusal(text)


def test_an_endless_row_of_undeclared_prefixes_ends():
    with pytest.raises(XmlError, match="Namespace prefix"):
        parse_urdf("<robot>" + "".join(f"<p{n}:a/>" for n in range(100)) + "</robot>")
