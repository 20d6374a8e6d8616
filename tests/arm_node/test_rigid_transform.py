"""Poses of single frames, against matrices."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from arm_node.rigid_transform import RigidTransform, quaternion_product, rotated

HALF = math.sqrt(0.5)
QUARTER_TURN = (0.0, 0.0, HALF, HALF)
"""Of 90 degrees about z."""
COMPONENT = st.floats(-1.0, 1.0)
QUATERNIONS = (
    st.tuples(COMPONENT, COMPONENT, COMPONENT, COMPONENT)
    .filter(lambda q: math.hypot(*q) > 0.1)
    .map(lambda q: tuple(component / math.hypot(*q) for component in q))
)
VECTORS = st.tuples(*[st.floats(-10.0, 10.0)] * 3)
POSES = st.builds(RigidTransform, VECTORS, QUATERNIONS)


def rotation(quaternion):
    return np.array(RigidTransform(rotation=quaternion).matrix())[:3, :3]


def test_a_quarter_turn_about_z_takes_x_to_y():
    assert rotated(QUARTER_TURN, (1.0, 0.0, 0.0)) == pytest.approx((0.0, 1.0, 0.0))


@settings(deadline=None)
@given(QUATERNIONS, VECTORS)
def test_vectors_are_rotated_as_by_the_matrix(quaternion, vector):
    assert rotated(quaternion, vector) == pytest.approx(rotation(quaternion) @ vector, abs=1e-9)


@settings(deadline=None)
@given(QUATERNIONS, QUATERNIONS)
def test_a_product_rotates_by_the_second_then_by_the_first(first, second):
    expected = rotation(first) @ rotation(second)
    np.testing.assert_allclose(rotation(quaternion_product(first, second)), expected, atol=1e-9)


@settings(deadline=None)
@given(POSES, POSES)
def test_poses_are_composed_like_matrices(outer, inner):
    expected = np.array(outer.matrix()) @ inner.matrix()
    np.testing.assert_allclose(outer.then(inner).matrix(), expected, atol=1e-9)


@settings(deadline=None)
@given(POSES)
def test_a_pose_and_its_inverse_cancel(pose):
    both = pose.then(pose.inverse())
    assert both.position == pytest.approx((0.0, 0.0, 0.0), abs=1e-9)
    assert both.rotation == pytest.approx((0.0, 0.0, 0.0, 1.0), abs=1e-9)


def test_roll_pitch_and_yaw():
    assert RigidTransform(rotation=QUARTER_TURN).rpy() == pytest.approx((0.0, 0.0, math.pi / 2))
    assert RigidTransform(rotation=(0.0, HALF, 0.0, HALF)).rpy()[1] == pytest.approx(math.pi / 2)
