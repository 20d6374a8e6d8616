"""The life of goals: the cases of upstream's test_trajectory_actions.cpp, and more."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from arm_control.joint_trajectory.requests import GoalRequest, JointTolerance
from arm_control.joint_trajectory.results import ErrorCode, GoalResult, Outcome

MakeRig = Callable[..., Any]

SUCCESS = GoalResult(Outcome.SUCCEEDED, ErrorCode.SUCCESSFUL, "Goal successfully reached!")
GOAL_TOLERANCES = {f"constraints__j{i}__goal": 0.1 for i in range(3)}
PATH_TOLERANCES = {f"constraints__j{i}__trajectory": 0.0001 for i in range(3)}
ONE_POINT = [(0.5, [1.0, 2.0, 3.0])]
TWO_POINTS = [(0.2, [4.0, 5.0, 6.0]), (0.3, [7.0, 8.0, 9.0])]


def aborted(code: ErrorCode, message: str) -> GoalResult:
    return GoalResult(Outcome.ABORTED, code, message)


class TestSuccess:
    def test_single_point(self, make_rig: MakeRig):
        rig = make_rig()
        rig.goal(ONE_POINT)
        rig.run(1.0)

        assert rig.result == SUCCESS
        assert rig.measured().tolist() == [1.0, 2.0, 3.0]

    def test_single_point_with_velocity(self, make_rig: MakeRig):
        rig = make_rig()
        rig.goal([(0.5, [1.0, 2.0, 3.0], [0.0, 0.0, 0.0])])
        rig.run(1.0)

        assert rig.result == SUCCESS
        assert rig.measured().tolist() == [1.0, 2.0, 3.0]

    def test_multi_point(self, make_rig: MakeRig):
        rig = make_rig()
        rig.goal(TWO_POINTS)
        rig.run(1.0)

        assert rig.result == SUCCESS
        assert rig.measured().tolist() == [7.0, 8.0, 9.0]
        assert rig.sink.feedback

    def test_multi_point_with_velocity(self, make_rig: MakeRig):
        rig = make_rig(commands=("position", "velocity"))
        rig.goal([(0.2, [4.0, 5.0, 6.0], [1.0, 1.0, 1.0]), (0.3, [7.0, 8.0, 9.0], [0.0, 0.0, 0.0])])
        rig.run(1.0)

        assert rig.result == SUCCESS
        assert rig.measured().tolist() == [7.0, 8.0, 9.0]

    @pytest.mark.parametrize("points", [ONE_POINT, TWO_POINTS], ids=["single", "multi"])
    def test_goal_tolerances(self, make_rig: MakeRig, points: list[Any]):
        rig = make_rig(**GOAL_TOLERANCES)
        rig.goal(points)
        rig.run(1.0)

        assert rig.result == SUCCESS

    def test_in_the_very_cycle_of_the_end(self, make_rig: MakeRig):
        rig = make_rig()
        rig.goal(ONE_POINT)
        rig.tick(50)
        assert rig.result is None

        rig.tick()
        assert rig.result == SUCCESS

    def test_the_last_segment_is_not_cut(self, make_rig: MakeRig):
        rig = make_rig()
        rig.goal([(0.5, [1.0, 1.0, 1.0]), (1.0, [2.0, 2.0, 2.0])])
        commanded = []
        for _ in range(101):
            rig.tick()
            commanded.append(rig.commanded()[0])

        # The command of each cycle is what is wanted one period later.
        assert np.allclose(np.diff(commanded[:100]), 0.02)
        assert commanded[99] == pytest.approx(2.0)

    def test_the_last_point_is_repeated_afterwards(self, make_rig: MakeRig):
        rig = make_rig(**GOAL_TOLERANCES, constraints__goal_time=0.1)
        rig.goal(ONE_POINT)
        rig.run(1.0)
        rig.place([9.0, 9.0, 9.0])
        rig.moves = False
        rig.run(1.0)

        assert rig.commanded().tolist() == [1.0, 2.0, 3.0], "nothing is checked any more"

    def test_a_goal_without_any_way_to_go(self, make_rig: MakeRig):
        rig = make_rig()
        rig.goal([(0.0, [0.0, 0.0, 0.0])])
        rig.tick()

        assert rig.result == SUCCESS


class TestTolerances:
    def test_tolerances_via_actions(self, make_rig: MakeRig):
        rig = make_rig(**GOAL_TOLERANCES)
        rig.goal(
            ONE_POINT,
            path_tolerance=[JointTolerance("j1", 0.5)],
            goal_tolerance=[JointTolerance("j0", 5.0)],
        )
        rig.tick(10)
        rig.place([0.2, 3.0, 0.6])
        rig.tick()

        assert rig.result.code is ErrorCode.PATH_TOLERANCE_VIOLATED

    def test_a_goal_can_switch_tolerances_off(self, make_rig: MakeRig):
        rig = make_rig(**PATH_TOLERANCES)
        rig.moves = False
        rig.goal(ONE_POINT, path_tolerance=[JointTolerance(f"j{i}", -1.0) for i in range(3)])
        rig.run(1.0)

        assert rig.result == SUCCESS

    @pytest.mark.parametrize("tolerance", [JointTolerance("j0", -5.0), JointTolerance("j9", 1.0)])
    def test_bad_ones_fall_back_to_the_defaults(
        self, make_rig: MakeRig, tolerance: JointTolerance, caplog: pytest.LogCaptureFixture
    ):
        rig = make_rig(**PATH_TOLERANCES)
        rig.moves = False
        rig.goal(ONE_POINT, path_tolerance=[JointTolerance("j1", 99.0), tolerance])
        rig.tick(5)

        assert rig.result.code is ErrorCode.PATH_TOLERANCE_VIOLATED
        assert "the default tolerances are used" in caplog.text

    def test_state_tolerances_fail(self, make_rig: MakeRig):
        rig = make_rig(**PATH_TOLERANCES)
        rig.moves = False
        rig.goal([(1.0, [4.0, 5.0, 6.0])])
        rig.run(0.5)

        assert rig.result == aborted(
            ErrorCode.PATH_TOLERANCE_VIOLATED, "Aborted due to path tolerance violation"
        )
        assert rig.commanded().tolist() == rig.measured().tolist() == [0.0, 0.0, 0.0]

    def test_goal_tolerances_fail(self, make_rig: MakeRig):
        rig = make_rig(**GOAL_TOLERANCES, constraints__goal_time=0.05)
        rig.moves = False
        rig.goal(ONE_POINT)
        rig.run(1.0)

        assert rig.result == aborted(
            ErrorCode.GOAL_TOLERANCE_VIOLATED,
            "Aborted due to goal_time_tolerance exceeding by 0.060000 seconds",
        )
        assert rig.commanded().tolist() == [0.0, 0.0, 0.0]

    def test_without_a_goal_time_it_waits_for_ever(self, make_rig: MakeRig):
        rig = make_rig(**GOAL_TOLERANCES)
        rig.moves = False
        rig.goal(ONE_POINT)
        rig.run(20.0)
        assert rig.result is None

        rig.place([1.0, 2.0, 3.0])
        rig.tick()
        assert rig.result == SUCCESS

    def test_within_tolerance_in_time_is_success(self, make_rig: MakeRig):
        rig = make_rig(**GOAL_TOLERANCES, constraints__goal_time=0.5)
        rig.moves = False
        rig.goal(ONE_POINT)
        rig.run(0.8)
        rig.place([1.05, 2.0, 3.0])
        rig.tick()

        assert rig.result == SUCCESS

    def test_no_time_from_start_state_tolerance_fail(self, make_rig: MakeRig):
        rig = make_rig(**PATH_TOLERANCES)
        rig.moves = False
        rig.goal([(0.0, [4.0, 5.0, 6.0])])
        rig.tick()

        assert rig.result.code is ErrorCode.PATH_TOLERANCE_VIOLATED

    def test_the_log_names_the_joint(self, make_rig: MakeRig, caplog: pytest.LogCaptureFixture):
        rig = make_rig(constraints__j1__trajectory=0.01)
        rig.moves = False
        rig.goal([(1.0, [0.0, 5.0, 0.0])])
        rig.tick(2)

        assert "position error of joint j1 is 0.050000, tolerance 0.010000" in caplog.text

    def test_stopped_velocity_counts_where_velocity_is_commanded(self, make_rig: MakeRig):
        rig = make_rig(commands=("position", "velocity"))
        rig.goal([(0.5, [1.0, 2.0, 3.0], [0.0, 0.0, 0.0])])
        rig.tick(50)
        rig.moves = False
        rig.place([0.5, 0.0, 0.0], "velocity")
        rig.run(1.0)
        assert rig.result is None

        rig.place([0.005, 0.0, 0.0], "velocity")
        rig.tick()
        assert rig.result == SUCCESS

    def test_stopped_velocity_does_not_count_where_only_positions_are(self, make_rig: MakeRig):
        rig = make_rig()
        rig.place([0.5, 0.0, 0.0], "velocity")
        rig.goal(ONE_POINT)
        rig.run(1.0)

        assert rig.result == SUCCESS


class TestEnd:
    def test_preempted_goal_receives_aborted_result(self, make_rig: MakeRig):
        rig = make_rig()
        rig.goal(ONE_POINT, "first")
        rig.tick(10)
        rig.goal([(0.5, [-1.0, -1.0, -1.0])], "second")
        rig.tick()

        assert rig.sink.results == {
            "first": aborted(
                ErrorCode.INVALID_GOAL, "Current goal preempted by new incoming action."
            )
        }
        rig.run(1.0)
        assert rig.sink.results["second"] == SUCCESS
        assert rig.measured().tolist() == [-1.0, -1.0, -1.0]

    def test_goals_of_one_cycle_preempt_each_other(self, make_rig: MakeRig):
        rig = make_rig()
        for name in ("first", "second", "third"):
            rig.goal(ONE_POINT, name)
        rig.tick()

        assert list(rig.sink.results) == ["first", "second"]

    def test_a_trajectory_on_the_topic_ends_the_goal(self, make_rig: MakeRig):
        rig = make_rig()
        rig.goal(ONE_POINT)
        rig.tick(10)
        rig.trajectory([(0.5, [-1.0, -1.0, -1.0])])
        rig.tick()

        assert rig.result == aborted(
            ErrorCode.INVALID_GOAL, "Current goal preempted by a trajectory on the topic."
        )

    def test_cancel_hold_position(self, make_rig: MakeRig):
        rig = make_rig()
        rig.goal([(1.0, [4.0, 5.0, 6.0])])
        rig.run(0.5)
        where = rig.measured()
        rig.controller.cancel_goal("goal")
        rig.tick()

        assert rig.result == GoalResult(Outcome.CANCELED, ErrorCode.SUCCESSFUL, "")
        rig.run(1.0)
        assert rig.commanded().tolist() == where.tolist()

    def test_cancel_of_another_goal_changes_nothing(self, make_rig: MakeRig):
        rig = make_rig()
        rig.goal(ONE_POINT)
        rig.controller.cancel_goal("another")
        rig.run(1.0)

        assert rig.result == SUCCESS

    def test_cancel_after_the_end_changes_nothing(self, make_rig: MakeRig):
        rig = make_rig()
        rig.goal(ONE_POINT)
        rig.run(1.0)
        rig.controller.cancel_goal("goal")
        rig.tick()

        assert rig.result == SUCCESS
        assert rig.commanded().tolist() == [1.0, 2.0, 3.0]

    def test_cancel_in_the_cycle_of_the_start(self, make_rig: MakeRig):
        rig = make_rig()
        rig.goal(ONE_POINT)
        rig.controller.cancel_goal("goal")
        rig.run(1.0)

        assert rig.result.outcome is Outcome.CANCELED
        assert rig.commanded().tolist() == [0.0, 0.0, 0.0]

    def test_cancel_works_while_time_stands_still(self, make_rig: MakeRig):
        rig = make_rig()
        rig.goal([(1.0, [4.0, 5.0, 6.0])])
        rig.run(0.5)
        rig.controller.cancel_goal("goal")
        rig.controller.serve_requests()

        assert rig.result.outcome is Outcome.CANCELED

    def test_deactivate_controller_aborts_action(self, make_rig: MakeRig):
        rig = make_rig()
        rig.goal(ONE_POINT)
        rig.run(0.2)
        rig.deactivate()

        assert rig.result == aborted(
            ErrorCode.INVALID_GOAL, "Current goal cancelled during deactivate transition."
        )

    def test_deactivation_ends_goals_that_were_not_even_begun(self, make_rig: MakeRig):
        rig = make_rig()
        rig.goal(ONE_POINT, "first")
        rig.goal(ONE_POINT, "second")
        rig.deactivate()

        assert rig.sink.results["first"].message.startswith("Current goal preempted")
        assert rig.sink.results["second"].message.endswith("during deactivate transition.")


class TestRefusal:
    def test_while_not_running(self, make_rig: MakeRig, make_request: Callable[..., Any]):
        rig = make_rig(activate=False)
        refusal = rig.controller.check_goal(make_request(ONE_POINT))

        assert refusal.message == "Can't accept new action goals. Controller is not running."
        assert rig.controller.submit_goal(GoalRequest(1, make_request(ONE_POINT))).code is (
            ErrorCode.INVALID_GOAL
        )

    def test_after_deactivation(self, make_rig: MakeRig, make_request: Callable[..., Any]):
        rig = make_rig()
        rig.deactivate()

        assert rig.controller.check_goal(make_request(ONE_POINT)) is not None

    def test_has_a_reason_for_goals_that_are_accepted_to_be_told(
        self, make_rig: MakeRig, make_request: Callable[..., Any]
    ):
        rig = make_rig(reject_with_reason=True)
        bad = make_request([(1.0, [1.0])], ["j9"])

        assert rig.controller.submit_goal(GoalRequest(1, bad)) == aborted(
            ErrorCode.INVALID_JOINTS,
            "Joints on incoming trajectory don't match the controller joints.",
        )
        assert not rig.sink.results, "the caller ends the goal, not the sink"

    def test_is_logged(
        self,
        make_rig: MakeRig,
        make_request: Callable[..., Any],
        caplog: pytest.LogCaptureFixture,
    ):
        make_rig().controller.check_goal(make_request([]))

        assert "Empty trajectory received." in caplog.text

    @pytest.mark.parametrize("allowed", [True, False])
    def test_allow_nonzero_velocity(
        self, make_rig: MakeRig, make_request: Callable[..., Any], allowed: bool
    ):
        rig = make_rig(allow_nonzero_velocity_at_trajectory_end=allowed)
        moving = make_request([(0.5, [1.0] * 3, [0.5] * 3)])

        assert (rig.controller.check_goal(moving) is None) is allowed

    def test_a_velocity_at_the_end_is_kept(self, make_rig: MakeRig):
        rig = make_rig(
            commands=("position", "velocity"), allow_nonzero_velocity_at_trajectory_end=True
        )
        rig.goal([(0.5, [1.0] * 3, [0.5] * 3)])
        rig.run(2.0)

        assert rig.result == SUCCESS
        assert rig.commanded("velocity").tolist() == [0.5, 0.5, 0.5]


class TestFeedback:
    def test_comes_at_its_rate_of_the_controllers_time(self, make_rig: MakeRig):
        rig = make_rig(action_monitor_rate=20.0)
        rig.goal([(1.0, [4.0, 5.0, 6.0])])
        rig.run(1.0)

        times = [feedback.time_s for _, feedback in rig.sink.feedback]
        assert len(times) == 20
        assert np.allclose(np.diff(times), 0.05)

    def test_does_not_drift_where_rates_do_not_divide(self, make_rig: MakeRig):
        rig = make_rig(action_monitor_rate=30.0)
        rig.goal([(10.0, [4.0, 5.0, 6.0])])
        rig.run(10.0)

        assert len(rig.sink.feedback) == 300

    def test_comes_in_every_cycle_where_more_is_asked_for(self, make_rig: MakeRig):
        rig = make_rig(action_monitor_rate=1000.0)
        rig.goal([(0.5, [4.0, 5.0, 6.0])])
        rig.run(0.5)

        assert len(rig.sink.feedback) == 50

    def test_tells_desired_actual_and_error(self, make_rig: MakeRig):
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

    def test_stops_with_the_goal(self, make_rig: MakeRig):
        rig = make_rig()
        rig.goal(ONE_POINT)
        rig.run(0.6)
        count = len(rig.sink.feedback)
        rig.run(1.0)

        assert len(rig.sink.feedback) == count

    def test_nobody_needs_to_listen(self, make_rig: MakeRig):
        rig = make_rig(activate=False)
        rig.controller.sink = None
        rig.activate()
        rig.goal(ONE_POINT)
        rig.run(1.0)

        assert rig.measured().tolist() == [1.0, 2.0, 3.0]


class TestSpeedScaling:
    def test_scaling_execution_time_succeeds(self, make_rig: MakeRig):
        rig = make_rig(speed_scaling__initial_scaling_factor=0.5)
        rig.goal(ONE_POINT)
        rig.run(0.95)
        assert rig.result is None

        rig.run(0.1)
        assert rig.result == SUCCESS

    def test_scaling_sampling_is_correct(self, make_rig: MakeRig):
        rig = make_rig()
        rig.controller.request_speed_scaling(0.1)
        rig.tick()
        rig.goal([(1.0, [1.0, 2.0, 3.0])])
        rig.tick()
        rig.run(5.0)

        assert rig.sink.state.reference[0] == pytest.approx([0.5, 1.0, 1.5])
        assert rig.commanded() == pytest.approx([0.501, 1.002, 1.503])
