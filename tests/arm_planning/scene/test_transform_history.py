"""Poses of frames at present and before."""

from math import cos, pi, sin

import pytest

from arm_node.rigid_transform import RigidTransform
from arm_planning.scene.transform_history import KEPT, TransformHistory

SECOND = 1_000_000_000


def at(x, turn=0.0):
    return RigidTransform((x, 0.0, 0.0), (0.0, 0.0, sin(turn / 2), cos(turn / 2)))


def moving():
    history = TransformHistory()
    history.add_static("eye", "hand", at(1.0))
    history.add("hand", "base", at(2.0), SECOND)
    history.add("hand", "base", at(4.0, turn=0.2), 2 * SECOND)
    return history


def test_without_a_time_the_last_poses_count():
    assert moving().pose("hand", "base") == at(4.0, turn=0.2)
    assert moving().pose("base", "hand").position == pytest.approx(
        (-4 * cos(0.2), 4 * sin(0.2), 0.0)
    )


@pytest.mark.parametrize(
    ("time_s", "x", "turn"), [(0.5, 2, 0), (1, 2, 0), (1.25, 2.5, 0.05), (2, 4, 0.2), (9, 4, 0.2)]
)
def test_between_two_poses_it_is_interpolated_and_beyond_them_the_nearest_holds(time_s, x, turn):
    hand = moving().pose("hand", "base", int(time_s * SECOND))
    assert hand.position == pytest.approx((x, 0, 0))
    assert hand.rpy() == pytest.approx((0, 0, turn), abs=1e-4)


def test_what_is_fixed_moves_with_what_it_is_fixed_to():
    assert moving().pose("eye", "base", SECOND).position == pytest.approx((3, 0, 0))


def test_the_shorter_turn_is_taken_whatever_the_quaternions_sign():
    history = TransformHistory()
    history.add("hand", "base", at(0.0, turn=pi - 0.05), 0)
    history.add("hand", "base", at(0.0, turn=-pi + 0.05), SECOND)
    _, _, yaw = history.pose("hand", "base", SECOND // 2).rpy()
    assert abs(yaw) == pytest.approx(pi)


def test_unconnected_frames_have_no_pose_and_a_circle_does_no_harm():
    history = moving()
    history.add_static("a", "b", at(1.0))
    history.add_static("b", "a", at(1.0))
    assert history.pose("eye", "world") is None
    assert history.pose("a", "base") is None


def test_after_a_reset_nothing_of_before_is_left():
    history = moving()
    history.add("hand", "base", at(7.0), SECOND // 2)
    assert history.pose("hand", "base", 2 * SECOND).position == (7.0, 0.0, 0.0)


def test_a_change_of_the_parent_is_no_motion():
    history = moving()
    history.add("hand", "base2", at(0.0), 3 * SECOND)
    assert history.pose("hand", "base2", int(2.5 * SECOND)) == at(0.0)
    assert history.pose("hand", "base", int(1.5 * SECOND)) is not None


def test_only_the_last_poses_are_kept():
    history = TransformHistory()
    for second in range(2 * KEPT):
        history.add("hand", "base", at(float(second)), second * SECOND)
    assert history.pose("hand", "base", 0).position == (float(KEPT), 0.0, 0.0)
