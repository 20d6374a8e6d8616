"""Motions by move_group in MoveIt's ways: planned and executed, cancelled, stopped, blocked."""

import os
import sys
from contextlib import closing
from typing import Any

import pytest
from controller_manager_msgs.srv import SwitchController
from moveit_msgs.action import ExecuteTrajectory
from moveit_msgs.srv import GetPositionFK
from programs import RosProgram
from std_msgs.msg import String

SUCCESS, PREEMPTED, INVALIDATED, CONTROL_FAILED = 1, -7, -3, -4
SUCCEEDED, CANCELED, ABORTED = 4, 5, 6
TURN = "link1_to_link2"
SLOW = {"max_velocity_scaling_factor": 0.05}
"""A turn by 2 rad takes 14 s of the robot's time: long enough to come in between."""
NEAR = 0.02


@pytest.fixture
def turn_to(planning, request_of, joint_goal, joints):
    """Return a function that makes a request to turn the bent arm to an angle."""

    def make(angle: float, **fields: Any) -> Any:
        return request_of(joint_goal(joints(angle, -1.0)), **fields)

    return make


@pytest.fixture
def at_the_start(planning, turn_to):
    """Move the arm to the start of a turn, whatever was before."""
    planning.stands_still()
    ended = planning.move(turn_to(-1.0))
    assert ended.result.error_code.val == SUCCESS, ended.result.error_code.message


def half_way(planning: Any, joints: Any) -> list[float]:
    """Return where the flange of the bent arm passes at the angle 0."""
    request = GetPositionFK.Request(fk_link_names=["link6_flange"])
    request.robot_state.is_diff = True
    request.robot_state.joint_state.name = list(joints())
    request.robot_state.joint_state.position = list(joints(0.0, -1.0).values())
    position = planning.call("/compute_fk", request).pose_stamped[0].pose.position
    return [position.x, position.y, position.z]


def execute_goal(response: Any) -> Any:
    return ExecuteTrajectory.Goal(trajectory=response.trajectory)


def test_plan_and_execute_moves_the_arm_to_the_goal(planning, at_the_start, turn_to):
    goal = planning.start_move(turn_to(0.6))
    ended = goal.end()
    assert ended.status == SUCCEEDED
    assert ended.result.error_code.val == SUCCESS, ended.result.error_code.message
    assert ended.result.planned_trajectory.joint_trajectory.points
    assert planning.positions()[TURN] == pytest.approx(0.6, abs=NEAR)
    goal.feedback.wait_until(lambda states: "IDLE" in states, "the state IDLE")
    assert [state for state in goal.feedback.messages if state != "IDLE"] == ["PLANNING", "MONITOR"]


def test_plan_only_leaves_the_arm_where_it_is(planning, at_the_start, turn_to):
    ended = planning.move(turn_to(0.6), plan_only=True)
    assert ended.status == SUCCEEDED
    assert ended.result.planned_trajectory.joint_trajectory.points
    assert not ended.result.executed_trajectory.joint_trajectory.points
    assert planning.positions()[TURN] == pytest.approx(-1.0, abs=NEAR)


def test_a_cancelled_motion_ends_as_canceled_and_the_arm_stands_still(
    planning, at_the_start, turn_to
):
    goal = planning.start_move(turn_to(1.0, **SLOW))
    planning.joint_moves(TURN, by=0.05)
    goal.cancel()
    ended = goal.end()
    assert (ended.status, ended.result.error_code.val) == (CANCELED, PREEMPTED)
    assert ended.result.error_code.message
    assert planning.stands_still()[TURN] < 0.9


def test_two_goals_at_once_both_come_to_an_end(planning, at_the_start, turn_to):
    first, second = planning.start_move(turn_to(0.3)), planning.start_move(turn_to(0.6))
    ends = [goal.end() for goal in (first, second)]
    assert [end.status for end in ends] == [SUCCEEDED, SUCCEEDED]
    assert planning.positions()[TURN] == pytest.approx(0.6, abs=NEAR) or planning.positions()[
        TURN
    ] == pytest.approx(0.3, abs=NEAR)


def test_many_goals_at_once_can_all_be_cancelled(planning, at_the_start, turn_to):
    goals = [planning.start_move(turn_to(1.0, **SLOW))]
    planning.joint_moves(TURN, by=0.05)
    goals += [planning.start_move(turn_to(1.0, **SLOW)) for _ in range(9)]
    for goal in reversed(goals):
        goal.cancel()
    ends = [goal.end() for goal in goals]
    assert {(end.status, end.result.error_code.val) for end in ends} == {(CANCELED, PREEMPTED)}


def test_a_plan_is_executed_on_its_own(planning, at_the_start, turn_to):
    response = planning.plan(turn_to(0.4))
    goal = planning.send(ExecuteTrajectory, "/execute_trajectory", execute_goal(response))
    ended = goal.end()
    assert (ended.status, ended.result.error_code.val) == (SUCCEEDED, SUCCESS)
    assert planning.positions()[TURN] == pytest.approx(0.4, abs=NEAR)


def test_the_event_stop_preempts_a_motion(planning, at_the_start, turn_to):
    response = planning.plan(turn_to(1.0, **SLOW))
    goal = planning.send(ExecuteTrajectory, "/execute_trajectory", execute_goal(response))
    planning.joint_moves(TURN, by=0.05)
    planning.publish("/trajectory_execution_event", String(data="stop"))
    ended = goal.end()
    assert (ended.status, ended.result.error_code.val) == (ABORTED, PREEMPTED)
    assert planning.stands_still()[TURN] < 0.9


def test_a_plan_from_elsewhere_is_not_executed(planning, at_the_start, turn_to, joints):
    response = planning.plan(turn_to(0.4, start=joints(0.0, -1.0)))
    goal = planning.send(ExecuteTrajectory, "/execute_trajectory", execute_goal(response))
    ended = goal.end()
    assert (ended.status, ended.result.error_code.val) == (ABORTED, CONTROL_FAILED)
    assert TURN in ended.result.error_code.message


def test_a_box_put_into_the_way_stops_the_motion(planning, at_the_start, turn_to, joints, box):
    centre = half_way(planning, joints)
    goal = planning.start_move(turn_to(1.0, **SLOW))
    planning.joint_moves(TURN, by=0.05)
    assert planning.apply_object(box("late", centre, (0.04, 0.04, 0.04)))
    ended = goal.end()
    assert (ended.status, ended.result.error_code.val) == (ABORTED, INVALIDATED)
    assert "late" in ended.result.error_code.message
    assert planning.stands_still()[TURN] < 0.0


@pytest.fixture
def deactivate(planning):
    """Return a function that deactivates a controller until the end of the test."""
    stopped: list[str] = []

    def switch(**names: list[str]) -> None:
        request = SwitchController.Request(strictness=SwitchController.Request.STRICT, **names)
        name = "/controller_manager/switch_controller"
        assert planning.client.call(SwitchController, name, request).ok

    def stop(name: str) -> None:
        switch(deactivate_controllers=[name])
        stopped.append(name)

    yield stop
    switch(activate_controllers=stopped)


def test_a_controller_that_is_deactivated_midway_is_named(
    planning, at_the_start, turn_to, deactivate
):
    goal = planning.start_move(turn_to(1.0, **SLOW))
    planning.joint_moves(TURN, by=0.05)
    deactivate("arm_controller")
    for end in (goal.end(), planning.move(turn_to(0.5))):
        assert (end.status, end.result.error_code.val) == (ABORTED, CONTROL_FAILED)
        assert "arm_controller" in end.result.error_code.message


def test_joint_states_that_stop_are_said(planning, at_the_start, turn_to, deactivate):
    goal = planning.start_move(turn_to(-0.5, **SLOW))
    planning.joint_moves(TURN, by=0.05)
    deactivate("joint_state_broadcaster")
    assert goal.end().status == SUCCEEDED
    planned = planning.plan(turn_to(0.5)).error_code
    assert planned.val == SUCCESS
    assert "joint_states stopped" in planned.message
    ended = planning.move(turn_to(0.5))
    assert (ended.status, ended.result.error_code.val) == (ABORTED, CONTROL_FAILED)
    assert "joint_states stopped" in ended.result.error_code.message


def arm_move(*words: str) -> Any:
    return closing(RosProgram([sys.executable, "-m", "arm_cli", "move", *words], os.environ))


def test_arm_move_moves_the_arm_to_a_named_state(planning, launched, at_the_start):
    with arm_move("--state", "home") as program:
        assert "moved group 'arm'" in program.succeed()
    assert planning.positions()[TURN] == pytest.approx(0.0, abs=NEAR)


def test_arm_move_names_the_group_that_has_a_joint(planning, launched):
    with arm_move("--joints", "gripper_controller=-0.3") as program:
        said = program.fail()
    assert "group 'arm' has no joint 'gripper_controller'; --group gripper has it" in said
