"""What the clients of goals receive: refusals, feedback, and results at any speed."""

import numpy as np
import pytest

from arm_control.controllers.joint_trajectory.goals import (
    ErrorCode,
    GoalOutcome,
    GoalRequest,
    GoalResult,
)
from arm_control.controllers.joint_trajectory.state import Progress

SUCCESS = GoalResult(GoalOutcome.SUCCEEDED, ErrorCode.SUCCESSFUL, "Goal successfully reached!")
ONE_POINT = [(0.5, [1.0, 2.0, 3.0])]


def aborted(code: ErrorCode, message: str) -> GoalResult:
    return GoalResult(GoalOutcome.ABORTED, code, message)


class TestRefusal:
    def test_while_not_running(self, make_rig, make_request):
        rig = make_rig(activate=False)
        refusal = rig.controller.check_goal(make_request(ONE_POINT))

        assert refusal.message == "Can't accept new action goals. Controller is not running."
        assert rig.controller.submit_goal(GoalRequest(1, make_request(ONE_POINT))).code is (
            ErrorCode.INVALID_GOAL
        )

    def test_after_deactivation(self, make_rig, make_request):
        rig = make_rig()
        rig.deactivate()

        assert rig.controller.check_goal(make_request(ONE_POINT)) is not None

    def test_has_a_reason_for_accepted_invalid_goals(self, make_rig, make_request):
        rig = make_rig(reject_with_reason=True)
        bad = make_request([(1.0, [1.0])], ["j9"])

        assert rig.controller.submit_goal(GoalRequest(1, bad)) == aborted(
            ErrorCode.INVALID_JOINTS,
            "Joints on incoming trajectory don't match the controller joints.",
        )
        assert not rig.sink.results, "the caller ends the goal, not the sink"

    def test_is_logged(self, make_rig, make_request, caplog):
        make_rig().controller.check_goal(make_request([]))

        assert "Empty trajectory received." in caplog.text

    @pytest.mark.parametrize("allowed", [True, False])
    def test_allow_nonzero_velocity(self, make_rig, make_request, allowed):
        rig = make_rig(allow_nonzero_velocity_at_trajectory_end=allowed)
        moving = make_request([(0.5, [1.0] * 3, [0.5] * 3)])

        assert (rig.controller.check_goal(moving) is None) is allowed

    def test_a_velocity_at_the_end_is_kept(self, make_rig):
        rig = make_rig(
            commands=("position", "velocity"), allow_nonzero_velocity_at_trajectory_end=True
        )
        rig.goal([(0.5, [1.0] * 3, [0.5] * 3)])
        rig.run(2.0)

        assert rig.result == SUCCESS
        assert rig.commanded("velocity").tolist() == [0.5, 0.5, 0.5]


class TestFeedback:
    def test_comes_at_its_rate_of_the_controllers_time(self, make_rig):
        rig = make_rig(action_monitor_rate=20.0)
        rig.goal([(1.0, [4.0, 5.0, 6.0])])
        rig.run(1.0)

        times = [feedback.time_s for _, feedback in rig.sink.feedback]
        assert len(times) == 20
        assert np.allclose(np.diff(times), 0.05)

    def test_does_not_drift_where_rates_do_not_divide(self, make_rig):
        rig = make_rig(action_monitor_rate=30.0)
        rig.goal([(10.0, [4.0, 5.0, 6.0])])
        rig.run(10.0)

        assert len(rig.sink.feedback) == 300

    def test_feedback_comes_in_every_cycle_at_a_higher_rate(self, make_rig):
        rig = make_rig(action_monitor_rate=1000.0)
        rig.goal([(0.5, [4.0, 5.0, 6.0])])
        rig.run(0.5)

        assert len(rig.sink.feedback) == 50

    def test_feedback_has_desired_actual_and_error(self, make_rig):
        rig = make_rig()
        rig.moves = False
        rig.goal([(1.0, [1.0, 2.0, 3.0])])
        rig.run(0.5)
        goal_id, feedback = rig.sink.feedback[5]

        assert goal_id == "goal"
        assert feedback.time_s == pytest.approx(10.26)
        assert feedback.desired[0] == pytest.approx([0.25, 0.5, 0.75])
        assert feedback.actual[0].tolist() == [0.0, 0.0, 0.0]
        assert feedback.error[0] == pytest.approx([0.25, 0.5, 0.75])

    def test_stops_with_the_goal(self, make_rig):
        rig = make_rig()
        rig.goal(ONE_POINT)
        rig.run(0.6)
        count = len(rig.sink.feedback)
        rig.run(1.0)

        assert len(rig.sink.feedback) == count

    def test_no_supervisor_is_needed(self, make_rig):
        rig = make_rig(activate=False)
        rig.controller.sink = None
        rig.activate()
        rig.goal(ONE_POINT)
        rig.run(1.0)

        assert rig.measured().tolist() == [1.0, 2.0, 3.0]


class TestSpeedScaling:
    def test_scaling_execution_time_succeeds(self, make_rig):
        rig = make_rig(speed_scaling__initial_scaling_factor=0.5)
        rig.goal(ONE_POINT)
        rig.run(0.95)
        assert rig.result is None

        rig.run(0.1)
        assert rig.result == SUCCESS

    def test_scaling_sampling_is_correct(self, make_rig):
        rig = make_rig()
        rig.controller.request_speed_scaling(0.1)
        rig.tick()
        rig.goal([(1.0, [1.0, 2.0, 3.0])])
        rig.tick()
        rig.run(5.0)

        assert rig.sink.state.reference[0] == pytest.approx([0.5, 1.0, 1.5])
        assert rig.commanded() == pytest.approx([0.501, 1.002, 1.503])


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
