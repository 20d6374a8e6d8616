"""Poses of frames, known from /tf or assumed."""

import math

import numpy as np
import pytest

from arm_description.transforms import quaternion_from_rpy
from arm_description.urdf.description import RobotDescription
from arm_description.urdf.parser import parse_urdf
from arm_node.rigid_transform import RigidTransform
from arm_viewer.scene.frames import assumed_transforms, frame_poses, unknown_joints
from arm_viewer.snapshot import Transform

HALF = math.sqrt(0.5)


def transform(parent, position, rpy=(0.0, 0.0, 0.0)):
    return Transform(parent, RigidTransform(position, tuple(quaternion_from_rpy(rpy).tolist())))


def test_a_chain_is_put_together_whatever_the_order():
    poses = frame_poses(
        {
            "tip": transform("arm", (1.0, 0.0, 0.0)),
            "arm": transform("base", (0.0, 0.0, 2.0), (0.0, 0.0, math.pi / 2)),
        }
    )
    assert poses["base"] == RigidTransform()
    assert poses["tip"].position == pytest.approx((0.0, 1.0, 2.0))
    assert poses["tip"].rotation == pytest.approx((0.0, 0.0, HALF, HALF))


def test_several_roots_stand_at_the_origin():
    poses = frame_poses({"a": transform("left", (1, 0, 0)), "b": transform("right", (0, 1, 0))})
    assert poses["left"] == poses["right"] == RigidTransform()
    assert poses.keys() == {"a", "b", "left", "right"}


def test_frames_in_a_circle_have_no_pose_and_the_others_do():
    poses = frame_poses(
        {
            "a": transform("b", (1, 0, 0)),
            "b": transform("a", (1, 0, 0)),
            "hand": transform("arm", (0, 0, 1)),
        }
    )
    assert poses.keys() == {"arm", "hand"}


URDF = """<robot name='r'><link name='base'/><link name='arm'/><link name='hand'/><link name='f'/>
  <joint name='turn' type='revolute'><parent link='base'/><child link='arm'/><axis xyz='0 1 0'/>
    <origin xyz='0 0 1'/><limit lower='-2' upper='2' effort='1' velocity='1'/></joint>
  <joint name='fixed' type='fixed'><parent link='arm'/><child link='hand'/>
    <origin xyz='0 0 1'/></joint>
  <joint name='grip' type='prismatic'><parent link='hand'/><child link='f'/><axis xyz='1 0 0'/>
    <limit lower='0.1' upper='0.3' effort='1' velocity='1'/></joint>
  <ros2_control name='s' type='system'><joint name='turn'>
    <command_interface name='position'><param name='initial_value'>0.5</param></command_interface>
    <state_interface name='position'><param name='initial_value'>{start}</param></state_interface>
  </joint></ros2_control></robot>"""
PLACES = {"base": "base", "arm": "arm", "hand": "hand", "f": "f"}


def test_the_state_interfaces_initial_value_takes_precedence():
    assert RobotDescription(URDF.format(start=1.5)).initial_values() == {"turn": 1.5}
    assert RobotDescription(URDF.format(start="nothing")).initial_values() == {"turn": 0.5}


def test_a_robot_without_joint_states_is_drawn_at_its_initial_pose():
    robot = parse_urdf(URDF.format(start=0))
    static = {"hand": Transform("arm", RigidTransform((0.0, 0.0, 1.0)))}
    assumed = assumed_transforms(robot, PLACES, {"turn": math.pi / 2}, static)
    assert assumed.keys() == {"arm", "f"}
    poses = frame_poses({**assumed, **static})
    np.testing.assert_allclose(poses["hand"].position, (1.0, 0.0, 1.0), atol=1e-9)
    # The finger cannot be at 0.
    np.testing.assert_allclose(poses["f"].position, (1.0, 0.0, 0.9), atol=1e-9)
    assert unknown_joints(robot, PLACES, static) == ["turn", "grip"]


@pytest.mark.parametrize("known", [{"arm", "hand", "f"}])
def test_nothing_is_assumed_if_there_are_transforms(known):
    robot = parse_urdf(URDF.format(start=0))
    assert assumed_transforms(robot, PLACES, {}, known) == {}
    assert unknown_joints(robot, PLACES, known) == []
