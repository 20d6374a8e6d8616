"""Trajectories and grips: to their end, or with the action's code and text."""

from collections.abc import Iterator

import numpy as np
import pytest

from arm_control.controllers.goals import GoalOutcome
from arm_control.controllers.joint_trajectory.goals import ErrorCode
from arm_sim import CallError, GoalError, JointTrajectory, Simulation

ARM, GRIPPER = "arm_controller", "gripper_action_controller"
THERE = JointTrajectory([1.0], [[0.2] * 6])


@pytest.fixture(scope="module")
def mycobot() -> Iterator[Simulation]:
    with Simulation("mycobot", world="empty") as simulation:
        yield simulation


def test_follow_runs_to_the_end(mycobot):
    begin_s = mycobot.time_s
    result = mycobot.follow(ARM, {"times_s": [0.5, 1.0], "positions": [[0.1] * 6, [0.2] * 6]})
    assert (result.outcome, result.code) == (GoalOutcome.SUCCEEDED, ErrorCode.SUCCESSFUL)
    assert mycobot.time_s - begin_s >= 1.0
    joints = mycobot[ARM].core.state_layout.joints
    assert [mycobot.joints[j].position for j in joints] == pytest.approx([0.2] * 6, abs=0.02)


def test_a_goal_advances_while_the_simulation_runs(mycobot):
    goal = mycobot[ARM].follow(THERE)
    mycobot.run(0.3)
    assert not goal.done
    assert goal.feedback is not None
    with pytest.raises(CallError, match="has not ended; run the simulation"):
        _ = goal.result
    mycobot.run(1.0)
    assert goal.result.message == "Goal successfully reached!"


def test_a_cancelled_goal_is_an_error(mycobot):
    goal = mycobot[ARM].follow(THERE)
    goal.cancel()
    with pytest.raises(GoalError, match="was canceled") as caught:
        _ = goal.result
    assert caught.value.outcome is GoalOutcome.CANCELED


def test_a_new_goal_preempts_the_old_one(mycobot):
    first, second = mycobot[ARM].follow(THERE), mycobot[ARM].follow(THERE)
    mycobot.run(2.0)
    with pytest.raises(GoalError, match="preempted by new incoming action") as caught:
        _ = first.result
    assert caught.value.code == ErrorCode.INVALID_GOAL
    assert second.result.outcome is GoalOutcome.SUCCEEDED


def test_a_rejected_goal_has_the_action_s_code(mycobot):
    with pytest.raises(GoalError, match="don't match the controller joints") as caught:
        mycobot.follow(ARM, JointTrajectory([1.0], [[0.1]], joints=("elbow",)))
    assert caught.value.code == ErrorCode.INVALID_JOINTS
    assert caught.value.outcome is None


def test_a_goal_that_lasts_too_long_is_cancelled(mycobot):
    with pytest.raises(GoalError, match=r"'arm_controller' has not ended after 0\.1 s"):
        mycobot.follow(ARM, THERE, timeout_s=0.1)


@pytest.mark.parametrize(
    ("trajectory", "message"),
    [
        ({"times": [1.0]}, "a trajectory has the keys times_s, positions"),
        ([1.0], "a trajectory is a JointTrajectory or a mapping"),
        (JointTrajectory([1.0, 2.0], [[0.0] * 6]), "2 times_s and 1 positions"),
        (JointTrajectory([1.0], [0.0] * 6), r"needs the shape \(m, n\)"),
        (JointTrajectory(["soon"], [[0.0] * 6]), "times_s of the trajectory must be numbers"),
    ],
)
def test_a_bad_trajectory_gets_a_sentence(mycobot, trajectory, message):
    with pytest.raises(CallError, match=message):
        mycobot.follow(ARM, trajectory)


def test_the_gripper_closes_and_reports_its_state(mycobot):
    result = mycobot.grip(GRIPPER, -0.5)
    assert result.reached_goal
    assert result.state is not None
    assert result.state.position == pytest.approx(-0.5, abs=0.02)
    assert np.isfinite(result.state.effort)


def test_a_goal_of_another_kind_of_controller_is_refused(mycobot):
    with pytest.raises(CallError, match="which does not follow trajectories"):
        mycobot.follow(GRIPPER, THERE)
    with pytest.raises(CallError, match="which does not move a gripper"):
        mycobot.grip(ARM, 0.0)
