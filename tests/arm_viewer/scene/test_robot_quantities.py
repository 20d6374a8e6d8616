"""Centres of mass, loads of joints and their colours."""

import math

import pytest

from arm_description.urdf.parser import parse_urdf
from arm_node.rigid_transform import RigidTransform
from arm_viewer.scene.robot_quantities import (
    FULL,
    HALF,
    IDLE,
    centre_of_mass,
    joint_loads,
    load_colour,
)
from arm_viewer.snapshot import JointReading

INERTIAL = (
    '<inertial><origin xyz="0 0 {z}"/><mass value="{mass}"/>'
    '<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>'
)
ARM = parse_urdf(
    "<robot name='r'>"
    f"<link name='base'>{INERTIAL.format(z=0.0, mass=3.0)}</link>"
    f"<link name='hand'>{INERTIAL.format(z=0.4, mass=1.0)}</link>"
    "<joint name='j' type='revolute'><parent link='base'/><child link='hand'/>"
    "<limit lower='-1' upper='1' effort='5' velocity='1'/></joint></robot>"
)
PLACES = {"base": "base", "hand": "hand"}


def test_the_centre_of_mass_is_that_of_all_links():
    # The hand is turned by half a turn about x: its own centre is below it.
    poses = {"base": RigidTransform(), "hand": RigidTransform((0, 0, 2.0), (1.0, 0, 0, 0))}
    mass, point = centre_of_mass(ARM, PLACES, poses)
    assert mass == 4.0
    assert point == pytest.approx((0.0, 0.0, (2.0 - 0.4) / 4.0))


def test_a_link_that_is_nowhere_leaves_no_centre():
    assert centre_of_mass(ARM, PLACES, {"base": RigidTransform()}) is None


def test_a_robot_without_masses_has_no_centre():
    bare = parse_urdf("<robot name='r'><link name='base'/></robot>")
    assert centre_of_mass(bare, PLACES, {"base": RigidTransform()}) is None


def test_a_load_is_the_part_of_the_limit():
    assert joint_loads(ARM, {"j": JointReading(0.0, 0.0, -2.5)}) == {"j": -0.5}
    assert joint_loads(ARM, {"j": JointReading(0.0, 0.0, math.nan)}) == {}
    assert joint_loads(ARM, {}) == {}


def test_colours_go_from_green_over_amber_to_red():
    assert [load_colour(load) for load in (0.0, -0.5, 1.0, 7.0)] == [IDLE, HALF, FULL, FULL]
