"""A description that is parsed once, and read by many."""

import math

import pytest

from arm_control import ControllerContext, parse_hardware_info, read_joint_limits
from arm_description import UrdfError, XmlError, parse_urdf
from arm_description.urdf.description import RobotDescription, as_description, text_of
from arm_description.urdf.xml_document import finite_number

ROBOT = """\
<robot name="r">
  <link name="base"/><link name="arm"/>
  <joint name="j" type="revolute">
    <parent link="base"/><child link="arm"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="1" velocity="2" effort="3"/>
  </joint>
  <ros2_control name="sim" type="system">
    <hardware><plugin>mock_components/GenericSystem</plugin></hardware>
    <joint name="j"><command_interface name="position"/></joint>
  </ros2_control>
</robot>
"""


def test_readers_of_a_document_find_what_they_find_in_its_text():
    document = RobotDescription(ROBOT)
    assert parse_urdf(document) == parse_urdf(ROBOT)
    assert parse_hardware_info(document) == parse_hardware_info(ROBOT)
    assert read_joint_limits(document) == read_joint_limits(ROBOT)


def test_a_document_has_one_robot_and_remarks_once():
    remarks = []
    document = RobotDescription(f"<urdf>{ROBOT}</urdf>")
    robot = parse_urdf(document, remark=remarks.append)
    assert document.is_wrapped
    assert len(remarks) == 1
    assert parse_urdf(document, remark=remarks.append) is robot
    assert len(remarks) == 1


def test_controllers_share_the_robot_of_their_managers_document():
    document = RobotDescription(ROBOT)
    robot = parse_urdf(document)
    context = ControllerContext.of("c", 100, document)
    assert context.robot_description == ROBOT
    assert context.read_robot() is robot
    assert ControllerContext("c", 100, ROBOT).read_robot() == robot
    assert ControllerContext("c", 100).read_robot() is None


def test_a_text_becomes_a_document_and_a_document_stays_itself():
    document = as_description(ROBOT, "arm.urdf")
    assert (document.text, document.source) == (ROBOT, "arm.urdf")
    assert as_description(document) is document
    assert text_of(document) == text_of(ROBOT) == ROBOT


def test_what_is_wrong_is_said_with_the_documents_source():
    with pytest.raises(XmlError, match=r"^arm\.urdf, line 1: not XML"):
        RobotDescription("<robot", "arm.urdf")
    with pytest.raises(UrdfError, match=r"^arm\.urdf, line 1: <thing> is not a robot"):
        parse_urdf(RobotDescription("<thing/>", "arm.urdf"))


def test_each_reader_reads_a_description_once():
    asked = []
    description = RobotDescription(ROBOT)

    def joints(given):
        asked.append(given)
        return [joint.name for joint in given.joints]

    assert description.read(joints) == description.read(joints) == ["j"]
    assert asked == [description]


def test_parts_have_their_lines():
    description = RobotDescription(ROBOT)
    lines = [(part.tag, part.line) for part in (*description.links, *description.joints)]
    assert lines == [("link", 2), ("link", 2), ("joint", 3)]
    [hardware] = description.ros2_control
    assert (hardware.line, hardware.find("joint/command_interface")[0].line) == (7, 9)


@pytest.mark.parametrize(
    "word", ["1_000", "\u0661", "nan", "inf", "1e400", "0x10", "", "1 2", "{pi}"]
)
def test_what_is_no_finite_number_in_decimals(word):
    assert math.isnan(finite_number(word))


@pytest.mark.parametrize(("word", "value"), [("-.5", -0.5), ("+2.", 2.0), ("1e-3", 0.001)])
def test_numbers_in_decimals(word, value):
    assert finite_number(word) == value
