"""A slider stays where the user put it until the joint rests, and follows it else."""

from arm_viewer.joint_follower import LONGEST_HOLD_S, STILL_S, JointFollower


def test_it_follows_whoever_moves_the_joint():
    follower = JointFollower(0.001)
    assert follower.shown(0.5, 0.0) == 0.5
    assert follower.shown(0.8, 0.1) == 0.8


def test_a_joint_that_trembles_moves_nothing():
    follower = JointFollower(0.001)
    follower.shown(0.5, 0.0)
    assert follower.shown(0.5004, 0.1) == 0.5


def test_what_is_no_number_is_not_shown():
    assert JointFollower(0.001).shown(float("nan"), 0.0) is None


def test_it_stays_where_the_user_put_it_until_the_joint_rests():
    follower = JointFollower(0.001)
    follower.shown(0.0, 0.0)
    follower.hold(1.0)
    for k in range(10):
        assert follower.shown(0.1 * k, 1.0 + 0.1 * k) is None
    # It went on moving until 1.9 s.
    assert follower.shown(0.9, 1.9 + 0.9 * STILL_S) is None
    assert follower.is_held(1.9 + 0.9 * STILL_S)
    assert follower.shown(0.9, 1.9 + 1.1 * STILL_S) == 0.9


def test_a_joint_that_others_keep_moving_does_not_hold_it_for_ever():
    follower = JointFollower(0.001)
    follower.hold(0.0)
    times = [0.1 * k for k in range(int(LONGEST_HOLD_S * 10) + 2)]
    shown = [follower.shown(time_s, time_s) for time_s in times]
    assert shown[-3] is None
    assert shown[-1] == times[-1]
