"""Rotations against each other and against their definitions."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from arm_description.transforms import (
    quaternion_from_rpy,
    rotation_about,
    rotation_from_rpy,
    rpy_from_rotation,
    transform,
)
from arm_node.rigid_transform import RigidTransform

ANGLES = st.floats(-7.0, 7.0)
RPY = st.tuples(ANGLES, ANGLES, ANGLES)
X, Y, Z = np.eye(3)


@settings(deadline=None)
@given(RPY)
def test_roll_pitch_yaw_turn_about_fixed_axes_in_this_order(rpy):
    roll, pitch, yaw = rpy
    expected = rotation_about(Z, yaw) @ rotation_about(Y, pitch) @ rotation_about(X, roll)
    assert np.allclose(rotation_from_rpy(rpy), expected, atol=1e-12)


@settings(deadline=None)
@given(RPY)
def test_the_quaternion_turns_as_the_matrix_does(rpy):
    rotation = tuple(quaternion_from_rpy(rpy).tolist())
    matrix = np.array(RigidTransform(rotation=rotation).matrix())[:3, :3]
    assert np.allclose(matrix, rotation_from_rpy(rpy), atol=1e-12)


def test_a_quarter_turn_about_z_takes_x_to_y():
    assert np.allclose(rotation_about((0.0, 0.0, 1.0), np.pi / 2) @ X, Y)


@settings(deadline=None)
@given(RPY)
def test_roll_pitch_yaw_are_found_again(rpy):
    rotation = rotation_from_rpy(rpy)
    assert np.allclose(rotation_from_rpy(rpy_from_rotation(rotation)), rotation, atol=1e-7)


def test_roll_pitch_yaw_of_what_points_upwards():
    rotation = rotation_from_rpy((0.3, -np.pi / 2, 0.4))
    assert np.allclose(rotation_from_rpy(rpy_from_rotation(rotation)), rotation, atol=1e-7)


def test_a_transform_turns_then_shifts():
    pose = transform(rotation_about(Z, np.pi / 2), (0.0, 0.0, 5.0))
    assert np.allclose(pose @ [1, 0, 0, 1], [0, 1, 5, 1])
