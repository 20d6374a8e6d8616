"""The action ~/follow_joint_trajectory, from a client's goal to its result."""

import threading
from collections.abc import Iterator
from itertools import pairwise
from typing import Any

import pytest
from control_msgs.action import FollowJointTrajectory

NAME = "joint_trajectory_controller"
SUCCEEDED, CANCELED, ABORTED = 4, 5, 6
HERE = (0.0, 0.0, 0.0, 0.0)
THERE = (0.1, 0.2, 0.3, 0.4)
FOR_EVER_S = 1000.0

PREEMPTED = (ABORTED, -1, "Current goal preempted by new incoming action.")
REACHED = (SUCCEEDED, 0, "Goal successfully reached!")


@pytest.fixture
def paused(manager) -> Iterator[Any]:
    """Return a manager whose time a test may stop; it goes on afterwards."""
    yield manager
    manager.tell("resume")


def test_feedback_comes_at_its_rate_of_the_controllers_time(active, send):
    goal = send((0.5, THERE))
    goal.result()
    messages = goal.feedback.wait_for(9)  # The result may be taken before the last of it.
    stamps = [m.header.stamp.sec + m.header.stamp.nanosec * 1e-9 for m in messages]
    assert all(
        after - before == pytest.approx(0.05, abs=1e-6) for before, after in pairwise(stamps)
    )
    last = messages[-1]
    assert list(last.joint_names) == ["j0", "j1", "j2", "j3"]
    assert last.error.positions[0] == pytest.approx(
        last.desired.positions[0] - last.actual.positions[0]
    )
    assert len(last.actual.velocities) == 4


def test_an_invalid_goal_is_rejected_with_the_reason(active, send, manager):
    assert not send((1.0, HERE), joints=("j0", "j1", "j2", "j9")).accepted
    manager.wait_for_line("Incoming joint j9 doesn't match the controller's joints.")


def test_a_goal_with_a_fault_can_be_aborted_with_the_reason(active, send, set_parameter):
    assert set_parameter(f"/{NAME}", "reject_with_reason", True).successful
    status, code, text = send((1.0, HERE), joints=("j0", "j1", "j2", "j9")).result()
    assert (status, code) == (ABORTED, -2)
    assert text == "Incoming joint j9 doesn't match the controller's joints."


def test_a_goal_is_preempted_while_paused(active, send, paused):
    first = send((FOR_EVER_S, THERE))
    paused.tell("pause")
    second = send((0.1, THERE))
    assert first.result() == PREEMPTED
    assert not second.ended()
    paused.tell("resume")
    assert second.result() == REACHED


def test_a_goal_is_cancelled_while_paused(active, send, paused):
    goal = send((FOR_EVER_S, THERE))
    paused.tell("pause")
    assert goal.cancel() == 1
    assert goal.result() == (CANCELED, 0, "")


def test_a_goal_that_has_ended_cannot_be_cancelled(active, send):
    goal = send((0.1, THERE))
    assert goal.result() == REACHED
    assert goal.cancel() == 0


def test_goals_of_any_length_are_taken(active, send):
    longest_s = 2.0e9
    goal = send((1.0, HERE), (longest_s, THERE))
    goal.wait_until_running()
    points = [(0.01 * (i + 1), THERE) for i in range(3000)]
    assert send(*points).accepted
    assert goal.result() == PREEMPTED
    assert send((0.1, THERE)).result() == REACHED


def test_a_flood_of_goals_leaves_the_last_one(active, client, send, manager):
    assert send((0.1, THERE)).result() == REACHED
    sent = threading.Event()
    left = iter(range(100))

    def send_another() -> None:
        if next(left, None) is None:
            sent.set()
        else:
            send.send_and_forget((FOR_EVER_S, THERE))

    timer = client.node.create_timer(0.01, send_another)
    assert sent.wait(100.0)
    client.node.destroy_timer(timer)
    assert send((0.1, HERE)).result() == REACHED
    assert "callback failed" not in manager.output
    assert "Traceback" not in manager.output


def test_unloading_by_force_brings_the_result_first(active, send):
    goal = send((FOR_EVER_S, HERE))
    goal.wait_until_running()
    # Who has not asked when the action is withdrawn has no result coming.
    goal.wait_until_asked_for()
    assert active.call("reload_controller_libraries", force_kill=True).ok
    assert goal.result() == (ABORTED, -1, "Current goal cancelled during deactivate transition.")


def test_the_action_works_again_after_another_configure(active, send):
    assert send((0.1, THERE)).result() == REACHED
    assert active.switch([], [NAME]).ok
    assert active.configure(NAME)
    assert active.switch([NAME]).ok
    send.wait_for_server()
    assert send((0.1, HERE)).result() == REACHED


def test_a_client_that_dies_in_the_middle_of_a_goal_does_no_harm(
    active, send, send_and_die, trajectory, states, manager
):
    goal = FollowJointTrajectory.Goal(trajectory=trajectory((1.0, [0.5] * 4)))
    send_and_die(FollowJointTrajectory, f"/{NAME}/follow_joint_trajectory", goal)
    states.wait_until(
        lambda messages: messages and list(messages[-1].feedback.positions) == [0.5] * 4,
        "the goal goes on",
    )
    assert send((0.1, HERE)).result() == REACHED
    assert "callback failed" not in manager.output
