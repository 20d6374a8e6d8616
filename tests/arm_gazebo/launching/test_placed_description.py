"""The root of a description that is placed among several robots."""

from pathlib import Path

import numpy as np
import pytest

from arm_description.urdf.description_source import source_of, with_source
from arm_description.urdf.parser import parse_urdf
from arm_gazebo.launching.edited_description import placed

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
