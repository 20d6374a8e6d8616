"""Progress of a trajectory: `time_from_start` of the reference and of the feedback."""

import pytest

from arm_control.controllers.joint_trajectory.state import Progress

THERE = (1.0, 1.0, 1.0)


def test_counts_from_the_start_of_the_trajectory(make_rig):
    rig = make_rig()
    rig.run(0.5)
    rig.trajectory([(1.0, THERE)])
    rig.tick()
    assert rig.sink.state.progress == Progress(0.0, 0.0)
    rig.run(0.3)
    assert rig.sink.state.progress == pytest.approx((0.3, 0.3))


def test_goes_on_after_the_end(make_rig):
    rig = make_rig()
    rig.goal([(0.1, THERE)])
    rig.tick()
    rig.run(0.5)
    assert rig.result is not None
    assert rig.sink.state.progress == pytest.approx((0.5, 0.5))


def test_a_scaled_speed_slows_only_the_reference(make_rig):
    rig = make_rig(speed_scaling__initial_scaling_factor=0.5)
    rig.trajectory([(1.0, THERE)])
    rig.tick()
    rig.run(0.4)
    assert rig.sink.state.progress == pytest.approx((0.2, 0.4))
    assert rig.sink.state.progress.error_s == pytest.approx(-0.2)


def test_is_negative_before_a_start_in_the_future(make_rig):
    rig = make_rig()
    rig.tick()
    rig.trajectory([(1.0, THERE)], stamp_s=rig.time_s + 0.5)
    rig.tick()
    assert rig.sink.state.progress == pytest.approx((-0.49, -0.49))


def test_counts_from_a_stamp_in_the_past(make_rig):
    rig = make_rig()
    rig.tick()
    rig.trajectory([(1.0, THERE)], stamp_s=rig.time_s - 0.5)
    rig.tick()
    assert rig.sink.state.progress == pytest.approx((0.51, 0.51))


def test_a_hold_counts_from_its_own_start(make_rig):
    rig = make_rig()
    rig.goal([(1.0, THERE)])
    rig.tick()
    rig.run(0.5)
    rig.controller.cancel_goal("goal")
    rig.tick()
    assert rig.sink.state.progress == Progress(0.0, 0.0)


def test_feedback_has_it(make_rig):
    rig = make_rig(speed_scaling__initial_scaling_factor=0.5, action_monitor_rate=10.0)
    rig.goal([(1.0, THERE)])
    rig.tick()
    rig.run(0.2)
    assert [tuple(feedback.progress) for _, feedback in rig.sink.feedback] == [
        pytest.approx(expected) for expected in [(0.0, 0.0), (0.05, 0.1), (0.1, 0.2)]
    ]
