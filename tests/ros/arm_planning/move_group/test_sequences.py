"""Sequences of Pilz' motions, planned and run by a launched move_group."""

import re
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from action_msgs.msg import GoalStatus
from moveit_msgs.action import MoveGroupSequence
from moveit_msgs.msg import MotionSequenceItem, MotionSequenceRequest, MoveItErrorCodes
from moveit_msgs.srv import GetMotionSequence

SUCCESS = MoveItErrorCodes.SUCCESS
PTP = {
    "planner_id": "PTP",
    "max_velocity_scaling_factor": 0.5,
    "max_acceleration_scaling_factor": 0.5,
}


@pytest.fixture
def motion(request_of, joint_goal) -> Callable[..., MotionSequenceItem]:
    """Return a function that makes one motion of a sequence: joints to positions."""

    def make(goal: dict[str, float], radius: float = 0.0, **fields: Any) -> MotionSequenceItem:
        request = request_of(joint_goal(goal), **{**PTP, **fields})
        return MotionSequenceItem(req=request, blend_radius=radius)

    return make


@pytest.fixture
def planned(planning) -> Callable[..., Any]:
    """Return a function that plans motions with the service; it gives the response."""

    def plan(*items: MotionSequenceItem) -> Any:
        request = GetMotionSequence.Request(request=MotionSequenceRequest(items=list(items)))
        return planning.call("/plan_sequence_path", request).response

    return plan


@pytest.fixture
def run(planning) -> Callable[..., Any]:
    """Return a function that sends motions to the action; it gives the goal."""

    def send(*items: MotionSequenceItem, **options: Any) -> Any:
        goal = MoveGroupSequence.Goal(request=MotionSequenceRequest(items=list(items)))
        for name, value in options.items():
            setattr(goal.planning_options, name, value)
        return planning.send(MoveGroupSequence, "/sequence_move_group", goal)

    return send


def test_motions_of_a_group_become_one_trajectory_from_rest_to_rest(planned, motion, joints):
    response = planned(motion(joints(0.3)), motion(joints(0.3, 0.2)))
    assert response.error_code.val == SUCCESS
    (trajectory,) = response.planned_trajectories
    points = trajectory.joint_trajectory.points
    np.testing.assert_allclose(points[-1].positions[:2], [0.3, 0.2], atol=1e-6)
    assert not any(points[0].velocities)
    np.testing.assert_allclose(points[-1].velocities, 0.0, atol=1e-9)
    start = response.sequence_start.joint_state
    first = dict(zip(trajectory.joint_trajectory.joint_names, points[0].positions, strict=True))
    given = dict(zip(start.name, start.position, strict=True))
    assert first == pytest.approx({name: given[name] for name in first}, abs=1e-6)


def test_a_sequence_begins_at_the_start_state_of_its_first_motion(planned, motion, joints):
    response = planned(motion(joints(0.3), start=joints(0.8, 0.1)))
    assert response.error_code.val == SUCCESS
    first = response.planned_trajectories[0].joint_trajectory.points[0].positions
    np.testing.assert_allclose(first[:2], [0.8, 0.1], atol=1e-9)


def test_an_empty_sequence_succeeds(planned):
    response = planned()
    assert response.error_code.val == SUCCESS
    assert not response.planned_trajectories


@pytest.mark.parametrize(
    ("second", "code", "reason"),
    [
        (
            {"start": {"link1_to_link2": 0.1}},
            MoveItErrorCodes.INVALID_ROBOT_STATE,
            "Only the first request of group 'arm' may have a start state",
        ),
        ({"pipeline_id": "ompl"}, MoveItErrorCodes.FAILURE, "motion 1 .* 'ompl'"),
        ({"group_name": "leg"}, MoveItErrorCodes.INVALID_GROUP_NAME, "no group 'leg'"),
    ],
)
def test_a_sequence_that_is_wrong_says_why(planned, motion, joints, second, code, reason):
    response = planned(motion(joints(0.3)), motion(joints(0.4), **second))
    assert response.error_code.val == code, response.error_code.message
    assert re.search(reason, response.error_code.message), response.error_code.message
    assert not response.planned_trajectories


def test_a_sequence_through_a_thing_is_refused(planning, planned, motion, joints, box):
    assert planning.apply_object(box("wall", (0.0, -0.25, 0.3), (0.02, 0.3, 0.6)))
    response = planned(motion(joints(-1.5, 1.5)), motion(joints(1.5, 1.5)))
    assert response.error_code.val == MoveItErrorCodes.INVALID_MOTION_PLAN
    assert "wall" in response.error_code.message


def test_the_action_runs_all_trajectories_one_after_the_other(planning, run, motion, joints):
    gripper = motion({"gripper_controller": -0.2}, group_name="gripper")
    goal = run(motion(joints(0.3)), gripper, motion(joints(0.1)))
    end = goal.end()
    assert end.status == GoalStatus.STATUS_SUCCEEDED, end.result.response.error_code
    assert len(end.result.response.planned_trajectories) == 3
    at = planning.stands_still()
    assert at["link1_to_link2"] == pytest.approx(0.1, abs=0.01)
    assert at["gripper_controller"] == pytest.approx(-0.2, abs=0.02)
    goal.feedback.wait_until(
        lambda said: said == ["PLANNING", "MONITOR", "IDLE"], "all states of the goal"
    )


def test_plan_only_moves_nothing(planning, run, motion, joints):
    before = planning.stands_still()
    end = run(motion(joints(1.0)), plan_only=True).end()
    assert end.status == GoalStatus.STATUS_SUCCEEDED
    assert len(end.result.response.planned_trajectories) == 1
    assert planning.stands_still() == pytest.approx(before, abs=1e-3)


def test_cancelling_stops_the_robot_and_what_would_follow(planning, run, motion, joints):
    slow = {"max_velocity_scaling_factor": 0.05}
    gripper = motion({"gripper_controller": -0.6}, group_name="gripper")
    goal = run(motion(joints(2.5), **slow), gripper)
    planning.joint_moves("link1_to_link2", 0.02)
    goal.cancel()
    end = goal.end()
    assert end.status == GoalStatus.STATUS_CANCELED
    assert end.result.response.error_code.val == MoveItErrorCodes.PREEMPTED
    at = planning.stands_still()
    assert abs(at["link1_to_link2"]) < 2.0
    assert at["gripper_controller"] > -0.5
