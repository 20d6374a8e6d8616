"""Edited descriptions: a root that is placed, and copies whose names are unique."""

from pathlib import Path

import numpy as np
import pytest

from arm_description.errors import XmlError
from arm_description.urdf.description_source import source_of, with_source
from arm_description.urdf.parser import parse_urdf
from arm_description.urdf.xml_document import parse_xml
from arm_gazebo.launching.edited_description import copy_description, placed

BASE = "<link name='base'/>"
ON_WORLD = f"""<robot name='r'><link name='world'/>{BASE}<joint name='stand' type='fixed'>
  <parent link='world'/><child link='base'/><origin xyz='1 0 0' rpy='0 0 0.5'/></joint></robot>"""
POSE = (0.0, 2.0, 0.5, 0.0, 0.0, np.pi / 2)


def test_a_root_is_fixed_to_the_world():
    text = with_source(f"<robot name='r'>{BASE}</robot>", Path("/a.urdf"), [Path("/b")])
    assert source_of(placed(text, POSE)) == source_of(text)
    robot = parse_urdf(placed(text, POSE))
    (joint,) = robot.children("world")
    assert (robot.root, joint.child, joint.type) == ("world", "base", "fixed")
    assert joint.origin.xyz == pytest.approx((0.0, 2.0, 0.5))
    assert joint.origin.rpy == pytest.approx((0.0, 0.0, np.pi / 2))


def test_a_robot_on_its_own_world_link_moves_with_it():
    (joint,) = parse_urdf(placed(ON_WORLD, POSE)).children("world")
    assert joint.origin.xyz == pytest.approx((0.0, 3.0, 0.5))
    assert joint.origin.rpy == pytest.approx((0.0, 0.0, np.pi / 2 + 0.5))


def test_a_link_of_this_name_elsewhere_in_the_robot_keeps_it():
    text = f"""<robot name='r'>{BASE}<link name='world'/><joint name='arm' type='fixed'>
      <parent link='base'/><child link='world'/></joint></robot>"""
    robot = parse_urdf(placed(text, POSE))
    (joint,) = robot.children(robot.root)
    assert (robot.root, joint.child) == ("base_world", "base")
    assert joint.origin.xyz == pytest.approx((0.0, 2.0, 0.5))
    assert [below.child for below in robot.children("base")] == ["world"]


def test_a_joint_that_has_the_name_of_the_added_one_keeps_it():
    text = f"""<robot name='r'>{BASE}<link name='tip'/><joint name='world_to_base' type='fixed'>
      <parent link='base'/><child link='tip'/></joint></robot>"""
    robot = parse_urdf(placed(text, POSE))
    assert [joint.name for joint in robot.joints_in_tree_order] == [
        "world_to_base_2",
        "world_to_base",
    ]


def test_what_is_in_a_namespace_is_moved_too():
    text = ON_WORLD.replace("<robot", "<robot xmlns='http://www.ros.org'")
    (joint,) = parse_urdf(placed(text, POSE)).children("world")
    assert joint.origin.xyz == pytest.approx((0.0, 3.0, 0.5))


def test_without_a_pose_it_keeps_its_own_origin():
    (joint,) = parse_urdf(placed(ON_WORLD, ())).children("world")
    assert joint.origin.xyz == pytest.approx((1.0, 0.0, 0.0))
    assert joint.origin.rpy == pytest.approx((0.0, 0.0, 0.5))


GRIPPER = """<robot name="gripper">
  <link name="palm"/><link name="thumb"/><link name="finger"/>
  <joint name="grip" type="prismatic"><parent link="palm"/><child link="thumb"/>
    <limit lower="0" upper="1" effort="1" velocity="1"/></joint>
  <joint name="follow" type="prismatic"><parent link="palm"/><child link="finger"/>
    <limit lower="0" upper="1" effort="1" velocity="1"/><mimic joint="grip"/></joint>
  <gazebo reference="palm"><sensor name="palm" type="camera">
    <topic> /camera/color </topic><camera><camera_info_topic>info</camera_info_topic>
    <optical_frame_id>palm</optical_frame_id></camera></sensor></gazebo>
  <ros2_control name="grip" type="system"><joint name="grip">
    <param name="mimic">grip</param><command_interface name="position"/></joint></ros2_control>
</robot>"""


def test_links_and_joints_have_the_prefix_wherever_they_are_named():
    copy = copy_description(GRIPPER, "left")
    robot = parse_urdf(copy.text)
    assert robot.name == copy.name == "left"
    assert [link.name for link in robot.links] == ["left_palm", "left_thumb", "left_finger"]
    follower = robot.joint("left_follow")
    assert (follower.parent, follower.child) == ("left_palm", "left_finger")
    assert follower.mimic is not None
    assert follower.mimic.joint == "left_grip"
    document = parse_xml(copy.text)
    assert [e.get("reference") for e in document.iterfind("gazebo")] == ["left_palm"]
    assert [e.get("name") for e in document.iterfind("ros2_control/joint")] == ["left_grip"]
    assert [e.text for e in document.iter("optical_frame_id", "param")] == [
        "left_palm",
        "left_grip",
    ]
    assert copy.names == {
        name: f"left_{name}" for name in ("palm", "thumb", "finger", "grip", "follow")
    }


def test_what_only_has_the_name_of_a_link_keeps_it():
    document = parse_xml(copy_description(GRIPPER, "left").text)
    sensor = document.find("gazebo/sensor")
    assert (sensor.get("name"), sensor.get("type")) == ("palm", "camera")
    assert document.find("ros2_control").get("name") == "grip"


def test_an_absolute_topic_becomes_one_in_the_namespace():
    document = parse_xml(copy_description(GRIPPER, "left").text)
    texts = [element.text for element in document.iter("topic", "camera_info_topic")]
    assert texts == ["camera/color", "info"]


def test_all_copies_share_the_world_at_the_root_and_no_other_link():
    on_world = """<robot name="r"><link name="world"/><link name="base"/>
      <joint name="stand" type="fixed"><parent link="world"/><child link="base"/></joint></robot>"""
    robot = parse_urdf(copy_description(on_world, "a").text)
    assert [link.name for link in robot.links] == ["world", "a_base"]
    below = on_world.replace('"base"', '"x"').replace('"world"', '"base"').replace('"x"', '"world"')
    robot = parse_urdf(copy_description(below, "a").text)
    assert [link.name for link in robot.links] == ["a_base", "a_world"]


def test_the_source_stays_known():
    text = with_source(GRIPPER, Path("/a.urdf"), [Path("/b")])
    assert source_of(copy_description(text, "left").text) == source_of(text)


def test_a_text_that_is_not_xml_is_reported():
    with pytest.raises(XmlError, match="not XML"):
        copy_description("<robot", "left")
