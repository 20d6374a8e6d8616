"""Where frames are in their root."""

import math

import numpy as np
import pytest

from arm_description.transforms import quaternion_from_rpy, rotation_from_rpy
from arm_viewer.scene.frame_poses import FramePose, frame_poses, rotated
from arm_viewer.snapshot import Transform

HALF = math.sqrt(0.5)


def transform(parent, position, rpy=(0.0, 0.0, 0.0)):
    return Transform(parent, position, tuple(quaternion_from_rpy(rpy).tolist()))


def test_a_chain_is_put_together_whatever_the_order():
    poses = frame_poses(
        {
            "tip": transform("arm", (1.0, 0.0, 0.0)),
            "arm": transform("base", (0.0, 0.0, 2.0), (0.0, 0.0, math.pi / 2)),
        }
    )
    assert poses["base"] == FramePose()
    assert poses["tip"].position == pytest.approx((0.0, 1.0, 2.0))
    assert poses["tip"].rotation == pytest.approx((0.0, 0.0, HALF, HALF))


def test_several_roots_stand_at_the_origin():
    poses = frame_poses({"a": transform("left", (1, 0, 0)), "b": transform("right", (0, 1, 0))})
    assert poses["left"] == poses["right"] == FramePose()
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


def test_vectors_are_turned_as_by_the_matrix():
    rpy = (0.3, -1.1, 2.2)
    turned = rotated(tuple(quaternion_from_rpy(rpy).tolist()), (1.0, -2.0, 0.5))
    assert turned == pytest.approx(rotation_from_rpy(rpy) @ np.array([1.0, -2.0, 0.5]))
