"""The goals of every gripper controller: reached, stalled, cancelled, preempted, cut off."""

import math
from math import isnan, nan

import pytest

from arm_control.controllers.goals import GoalOutcome
from arm_control.controllers.gripper.goals import GripperRequest, GripperResult


def test_a_goal_ends_when_the_joint_is_there(rig):
    rig.place(0.0, velocity=0.3)
    rig.goal(0.4)
    rig.run(2.0)
    assert rig.result is None

    rig.place(0.395, velocity=0.3)
    rig.tick()
    assert (rig.result.outcome, rig.result.reached_goal, rig.result.stalled) == (
        GoalOutcome.SUCCEEDED,
        True,
        False,
    )
    assert (rig.result.state.position, rig.result.state.velocity) == (0.395, 0.3)


def test_a_joint_that_is_there_already_ends_the_goal_in_the_first_cycle(rig):
    rig.place(0.4)
    rig.goal(0.4)
    rig.tick()
    assert rig.result.reached_goal


def test_the_edge_of_the_tolerance_is_not_there(rig):
    rig.set(goal_tolerance=0.25)
    rig.goal(0.25)
    rig.tick()
    assert rig.result is None


def test_a_joint_at_rest_for_too_long_aborts_the_goal(rig):
    rig.place(0.1)
    rig.goal(0.4)
    rig.run(0.4)
    assert rig.result is None

    rig.run(0.2)
    assert (rig.result.outcome, rig.result.reached_goal, rig.result.stalled) == (
        GoalOutcome.ABORTED,
        False,
        True,
    )
    assert rig.result.state.position == 0.1


def test_a_stall_is_a_success_where_that_is_allowed(rig):
    rig.set(allow_stalling=True)
    rig.goal(0.4)
    rig.run(0.6)
    assert (rig.result.outcome, rig.result.stalled) == (GoalOutcome.SUCCEEDED, True)
    assert not rig.result.reached_goal


def test_a_moving_joint_does_not_stall_and_the_time_restarts_when_it_stops(rig):
    rig.goal(0.4)
    rig.run(0.4)
    rig.place(0.1, velocity=0.01)
    rig.tick()
    rig.place(0.2)
    rig.run(0.4)
    assert rig.result is None

    rig.run(0.2)
    assert rig.result.stalled


def test_every_goal_has_its_own_time_to_stall(rig):
    rig.goal(0.4, "first")
    rig.run(0.4)
    rig.goal(0.3)
    rig.run(0.4)
    assert rig.result is None


def test_a_stalled_gripper_keeps_its_grip(make_rig):
    rig = make_rig(stall_timeout=0.1)
    rig.goal(0.4)
    rig.run(0.5)
    assert rig.result.stalled
    assert rig.commanded() == 0.4


def test_cancelling_ends_the_goal_and_holds(make_rig):
    rig = make_rig()
    rig.goal(0.4)
    rig.place(0.15, velocity=0.3)
    rig.tick()
    rig.controller.cancel_goal("goal")
    rig.tick()
    assert rig.result.outcome is GoalOutcome.CANCELED
    assert rig.result.state is None
    assert rig.commanded() == 0.15


def test_cancelling_needs_no_tick(rig):
    rig.goal(0.4)
    rig.controller.cancel_goal("goal")
    rig.controller.serve_requests()
    assert rig.result.outcome is GoalOutcome.CANCELED


def test_cancelling_a_goal_that_has_ended_changes_nothing(make_rig):
    rig = make_rig()
    rig.place(0.4)
    rig.goal(0.4)
    rig.tick()
    rig.goal(0.6, "second")
    rig.controller.cancel_goal("goal")
    rig.tick()
    assert list(rig.sink.results) == ["goal"]
    assert rig.commanded() == 0.6


def test_a_new_goal_cancels_the_one_before(rig):
    rig.goal(0.4, "first")
    rig.tick()
    rig.goal(0.6)
    rig.tick()
    first = rig.sink.results["first"]
    assert (first.outcome, first.state, first.stalled) == (GoalOutcome.CANCELED, None, False)
    rig.place(0.6)
    rig.tick()
    assert rig.result.reached_goal


def test_deactivation_aborts_the_goal(rig):
    rig.goal(0.4)
    rig.tick()
    rig.switch("", "gripper")
    assert rig.result.outcome is GoalOutcome.ABORTED
    assert (rig.result.stalled, rig.result.reached_goal) == (False, False)


def test_deactivation_ends_goals_that_no_cycle_has_seen(rig):
    rig.goal(0.4, "first")
    rig.goal(0.5, "second")
    rig.switch("", "gripper")
    assert {name: result.outcome for name, result in rig.sink.results.items()} == {
        "first": GoalOutcome.CANCELED,
        "second": GoalOutcome.ABORTED,
    }


def test_a_goal_whose_client_is_gone_is_completed(rig):
    rig.controller.sink = None
    rig.goal(0.4)
    rig.place(0.4)
    rig.tick()
    rig.controller.sink = rig.sink
    rig.goal(0.4)
    rig.tick()
    assert list(rig.sink.results) == ["goal"]


def test_an_inactive_controller_takes_no_goal(make_rig):
    rig = make_rig(activate=False)
    request = GripperRequest("goal", [0.4])
    refusal = "Can't accept new action goals. Controller is not running."
    assert rig.controller.check_goal(request) == refusal
    assert rig.controller.submit_goal(request) == GripperResult(GoalOutcome.ABORTED, refusal)


def test_every_activation_is_reported_and_starts_at_the_joints_position(make_rig):
    rig = make_rig(activate=False)
    assert rig.sink.openings == 0
    rig.place(0.2)
    rig.switch("gripper")
    rig.tick()
    assert (rig.sink.openings, rig.commanded()) == (1, 0.2)
    rig.switch("", "gripper")
    rig.place(0.3)
    rig.switch("gripper")
    rig.tick()
    assert (rig.sink.openings, rig.commanded()) == (2, 0.3)


@pytest.mark.parametrize(
    ("request_", "sentence"),
    [
        (
            GripperRequest(1, []),
            "Received action goal with wrong number of position values, expects 1, got 0",
        ),
        (
            GripperRequest(1, [0.1, 0.2]),
            "Received action goal with wrong number of position values, expects 1, got 2",
        ),
        (
            GripperRequest(1, [0.1], efforts=[1.0, 2.0]),
            "Received action goal with wrong number of effort values, expects at most 1, got 2",
        ),
        (GripperRequest(1, [math.nan]), "Received action goal whose position is not finite: nan"),
        (
            GripperRequest(1, [0.1], efforts=[-math.inf]),
            "Received action goal whose effort is not finite: -inf",
        ),
        (
            GripperRequest(1, [0.1], velocities=[math.nan]),
            "Received action goal whose velocity is not finite: nan",
        ),
    ],
)
def test_a_goal_with_a_fault_is_refused_with_a_sentence(make_rig, caplog, request_, sentence):
    assert make_rig().controller.check_goal(request_) == sentence
    assert sentence in caplog.messages


def test_a_joint_whose_velocity_is_not_known_is_not_called_stalled(rig):
    rig.place(0.0, velocity=math.nan)
    rig.goal(0.4)
    rig.run(2.0)
    assert (rig.result.outcome, rig.result.stalled) == (GoalOutcome.ABORTED, False)


POSITION = "position_controllers/GripperActionController"


def test_a_cancel_holds_the_last_known_position(make_rig):
    rig = make_rig(POSITION)
    rig.goal(0.4)
    rig.tick(3)
    rig.place(0.2)
    rig.tick()
    rig.place(nan)
    rig.controller.cancel_goal("goal")
    rig.tick()
    rig.place(0.3)
    rig.run(1.0)

    assert rig.result.outcome is GoalOutcome.CANCELED
    assert rig.commanded() == 0.2


def test_an_activation_holds_the_position_as_soon_as_it_is_known(make_rig):
    rig = make_rig(POSITION, activate=False)
    rig.place(nan)
    rig.switch("gripper")
    rig.tick(3)
    assert isnan(rig.commanded())

    rig.place(0.2)
    rig.tick()
    rig.place(0.3)
    rig.tick()
    assert rig.commanded() == 0.2


def test_what_was_seen_before_an_activation_does_not_count(make_rig):
    rig = make_rig(POSITION)
    rig.place(0.2)
    rig.tick()
    rig.switch("", "gripper")
    rig.place(nan)
    rig.switch("gripper")
    rig.tick()

    assert isnan(rig.commanded())


@pytest.mark.parametrize(
    ("position", "velocity", "name"), [(nan, 0.0, "grip/position"), (0.4, nan, "grip/velocity")]
)
def test_no_goal_succeeds_on_a_state_that_is_not_a_number(rig, position, velocity, name):
    rig.set(allow_stalling=True)
    rig.goal(0.4)
    rig.place(position, velocity)
    rig.run(1.0)

    assert rig.result.outcome is GoalOutcome.ABORTED
    assert f"state {name} is not a number" in rig.result.message


def test_one_cycle_without_a_number_does_not_end_a_goal(rig):
    rig.place(0.2, velocity=0.1)
    rig.goal(0.4)
    rig.place(nan, nan)
    rig.tick()
    assert rig.result is None
    rig.place(0.4)
    rig.tick()
    assert rig.result.reached_goal
