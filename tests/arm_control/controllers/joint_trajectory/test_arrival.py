"""A goal without tolerances ends by time, but never where a joint has not followed."""

import pytest

from arm_control.controllers.joint_trajectory.goals import ErrorCode, GoalOutcome, JointTolerance

POINTS = [(0.5, [0.0, 0.6, 0.0])]
OFF = [JointTolerance("j1", -1.0)]


@pytest.mark.parametrize("options", [{}, {"goal_tolerance": OFF}, {"goal_time_tolerance_s": -1.0}])
def test_a_joint_that_rests_far_from_its_end_has_not_arrived(make_rig, options):
    rig = make_rig()
    rig.moves = False
    rig.place([0.0, 0.3, 0.0])
    rig.goal(POINTS, **options)
    rig.run(0.9)
    assert rig.result is None
    rig.run(0.2)
    assert rig.result.outcome is GoalOutcome.ABORTED
    assert rig.result.code is ErrorCode.GOAL_TOLERANCE_VIOLATED
    assert rig.result.message == (
        "Aborted: joint j1 does not follow: it rests 0.3 rad from the goal; "
        "constraints.j1.goal allows a larger error"
    )
    # It holds where it is.
    rig.tick()
    assert rig.commanded().tolist() == pytest.approx([0.0, 0.3, 0.0])


def test_a_joint_that_is_late_but_comes_closer_succeeds_by_time(make_rig):
    rig = make_rig()
    rig.moves = False
    rig.goal(POINTS)
    rig.run(0.5)
    for cycle in range(51):
        rig.place([0.0, 0.3 + cycle * 0.001, 0.0])
        rig.tick()
    assert rig.result is not None
    assert rig.result.outcome is GoalOutcome.SUCCEEDED


def test_the_error_of_a_weak_drive_does_not_matter(make_rig):
    rig = make_rig()
    rig.moves = False
    rig.place([0.0, 0.56, 0.0])
    rig.goal(POINTS)
    rig.run(0.52)
    assert rig.result.outcome is GoalOutcome.SUCCEEDED


def test_a_sliding_joint_is_far_from_millimetres_on(make_rig, robot_description):
    rig = make_rig(robot_description=robot_description("prismatic"))
    rig.moves = False
    rig.goal([(0.5, [0.0, 0.02, 0.0])])
    rig.run(1.2)
    assert "joint j1 does not follow: it rests 0.02 m from" in rig.result.message


def test_a_tolerance_of_the_user_decides(make_rig):
    rig = make_rig(constraints__j1__goal=0.4)
    rig.moves = False
    rig.place([0.0, 0.3, 0.0])
    rig.goal(POINTS)
    rig.run(0.52)
    assert rig.result.outcome is GoalOutcome.SUCCEEDED


def test_a_joint_that_is_not_commanded_does_not_count(make_rig):
    rig = make_rig(command_joints=("j0", "j2"))
    rig.moves = False
    rig.goal(POINTS)
    rig.run(0.52)
    assert rig.result.outcome is GoalOutcome.SUCCEEDED
