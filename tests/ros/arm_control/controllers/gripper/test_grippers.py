"""Gripper controllers on the simulated arm's last joint, from a client's goal to its result."""

from typing import Any

import pytest

SUCCEEDED, CANCELED, ABORTED = 4, 5, 6
GRIPPER, EFFORT, PARALLEL = "gripper_controller", "effort_gripper", "parallel_gripper"
SEND_GOAL = f"/{GRIPPER}/gripper_cmd/_action/send_goal"
BEYOND_ITS_LIMIT = -4.0


@pytest.fixture
def active(control):
    """Start the gripper that commands positions; return the manager's client."""
    control.start(GRIPPER)
    return control


@pytest.fixture
def patient(active, set_parameter):
    """Let goals beyond the joint's limit last for ever; return the manager's client."""
    assert set_parameter(f"/{GRIPPER}", "stall_timeout", 1e6).successful
    return active


def count_actions(client: Any) -> int:
    return client.node.count_services(SEND_GOAL)


def test_the_action_is_there_from_the_first_activation_on(control, client, grip, manager):
    control.load(GRIPPER)
    control.configure(GRIPPER)
    assert count_actions(client) == 0
    manager.wait_for_line("position_controllers/GripperActionController serves")

    assert control.switch([GRIPPER]).ok
    client.wait_until(lambda: count_actions(client) == 1, "the action")
    types = dict(client.node.get_service_names_and_types())
    assert types[SEND_GOAL] == ["control_msgs/action/GripperCommand_SendGoal"]

    assert control.switch([], [GRIPPER]).ok
    assert not grip(0.1).accepted
    manager.wait_for_line("Can't accept new action goals. Controller is not running.")
    assert control.unload(GRIPPER)
    client.wait_until(lambda: count_actions(client) == 0, "the end of the action")


def test_a_goal_is_reached(active, grip):
    answer = grip(-0.5, max_effort=5.0).wait()
    assert answer.status == SUCCEEDED
    assert (answer.result.reached_goal, answer.result.stalled) == (True, False)
    assert answer.result.position == pytest.approx(-0.5, abs=0.01)
    assert answer.result.effort == 5.0


def test_a_joint_that_cannot_go_on_aborts_the_goal(active, grip, manager):
    answer = grip(BEYOND_ITS_LIMIT).wait()
    assert answer.status == ABORTED
    assert (answer.result.reached_goal, answer.result.stalled) == (False, True)
    assert answer.result.position == pytest.approx(-3.14, abs=0.02)
    manager.wait_for_line("joint 'j3': position command -4 rad is beyond its limit of -3.14 rad")


def test_a_cancelled_goal_ends_with_an_empty_result(patient, grip):
    goal = grip(BEYOND_ITS_LIMIT)
    assert goal.cancel() == 1
    answer = goal.wait()
    assert answer.status == CANCELED
    assert (answer.result.position, answer.result.effort) == (0.0, 0.0)
    assert not answer.result.stalled


def test_the_action_works_again_after_another_configure(active, caller_of, grip):
    assert grip(-0.1).wait().status == SUCCEEDED
    assert active.switch([], [GRIPPER]).ok
    assert active.configure(GRIPPER)
    assert active.switch([GRIPPER]).ok
    caller_of(GRIPPER).wait_for_server()
    assert grip(-0.2).wait().status == SUCCEEDED


def test_effort_reaches_its_goal_and_pushes_a_wall_no_harder_than_allowed(control, grip):
    control.start(EFFORT)
    answer = grip(-0.4, max_effort=3.0, controller=EFFORT).wait()
    assert (answer.status, answer.result.reached_goal) == (SUCCEEDED, True)
    assert 0.0 < abs(answer.result.effort) <= 3.0
    answer = grip(1.5, max_effort=1.0, controller=EFFORT).wait()
    assert (answer.status, answer.result.stalled) == (ABORTED, True)
    assert answer.result.effort == pytest.approx(1.0)
    assert 0.2 < answer.result.position < 1.0


def test_parallel_reaches_its_goal_with_a_joint_state(control, grip_parallel):
    control.start(PARALLEL)
    answer = grip_parallel(-0.4, effort=[4.0]).wait()
    state = answer.result.state
    assert (answer.status, answer.result.reached_goal) == (SUCCEEDED, True)
    assert (list(state.name), list(state.effort)) == (["j3"], [4.0])
    assert state.position[0] == pytest.approx(-0.4, abs=0.01)
    answer = grip_parallel(BEYOND_ITS_LIMIT).wait()
    assert (answer.status, answer.result.stalled) == (ABORTED, True)
    assert list(answer.result.state.effort) == [10.0]
