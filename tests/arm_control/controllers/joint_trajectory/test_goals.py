"""The life of goals: the cases of upstream's test_trajectory_actions.cpp, and more."""

import numpy as np
import pytest

from arm_control.controllers.joint_trajectory.goals import (
    ErrorCode,
    GoalOutcome,
    GoalResult,
    JointTolerance,
)

SUCCESS = GoalResult(GoalOutcome.SUCCEEDED, ErrorCode.SUCCESSFUL, "Goal successfully reached!")
GOAL_TOLERANCES = {f"constraints__j{i}__goal": 0.1 for i in range(3)}
PATH_TOLERANCES = {f"constraints__j{i}__trajectory": 0.0001 for i in range(3)}
ONE_POINT = [(0.5, [1.0, 2.0, 3.0])]
TWO_POINTS = [(0.2, [4.0, 5.0, 6.0]), (0.3, [7.0, 8.0, 9.0])]


def aborted(code: ErrorCode, message: str) -> GoalResult:
    return GoalResult(GoalOutcome.ABORTED, code, message)


class TestSuccess:
    def test_single_point(self, make_rig):
        rig = make_rig()
        rig.goal(ONE_POINT)
        rig.run(1.0)

        assert rig.result == SUCCESS
        assert rig.measured().tolist() == [1.0, 2.0, 3.0]

    def test_single_point_with_velocity(self, make_rig):
        rig = make_rig()
        rig.goal([(0.5, [1.0, 2.0, 3.0], [0.0, 0.0, 0.0])])
        rig.run(1.0)

        assert rig.result == SUCCESS
        assert rig.measured().tolist() == [1.0, 2.0, 3.0]

    def test_multi_point(self, make_rig):
        rig = make_rig()
        rig.goal(TWO_POINTS)
        rig.run(1.0)

        assert rig.result == SUCCESS
        assert rig.measured().tolist() == [7.0, 8.0, 9.0]
        assert rig.sink.feedback

    def test_multi_point_with_velocity(self, make_rig):
        rig = make_rig(commands=("position", "velocity"))
        rig.goal([(0.2, [4.0, 5.0, 6.0], [1.0, 1.0, 1.0]), (0.3, [7.0, 8.0, 9.0], [0.0, 0.0, 0.0])])
        rig.run(1.0)

        assert rig.result == SUCCESS
        assert rig.measured().tolist() == [7.0, 8.0, 9.0]

    @pytest.mark.parametrize("points", [ONE_POINT, TWO_POINTS], ids=["single", "multi"])
    def test_goal_tolerances(self, make_rig, points):
        rig = make_rig(**GOAL_TOLERANCES)
        rig.goal(points)
        rig.run(1.0)

        assert rig.result == SUCCESS

    def test_in_the_very_cycle_of_the_end(self, make_rig):
        rig = make_rig()
        rig.goal(ONE_POINT)
        rig.tick(50)
        assert rig.result is None

        rig.tick()
        assert rig.result == SUCCESS

    def test_the_last_segment_is_not_cut(self, make_rig):
        rig = make_rig()
        rig.goal([(0.5, [1.0, 1.0, 1.0]), (1.0, [2.0, 2.0, 2.0])])
        commanded = []
        for _ in range(101):
            rig.tick()
            commanded.append(rig.commanded()[0])

        # The command of each cycle is what is wanted one period later.
        assert np.allclose(np.diff(commanded[:100]), 0.02)
        assert commanded[99] == pytest.approx(2.0)

    def test_the_last_point_is_repeated_afterwards(self, make_rig):
        rig = make_rig(**GOAL_TOLERANCES, constraints__goal_time=0.1)
        rig.goal(ONE_POINT)
        rig.run(1.0)
        rig.place([9.0, 9.0, 9.0])
        rig.moves = False
        rig.run(1.0)

        assert rig.commanded().tolist() == [1.0, 2.0, 3.0], "nothing is checked any more"

    def test_a_goal_without_any_motion(self, make_rig):
        rig = make_rig()
        rig.goal([(0.0, [0.0, 0.0, 0.0])])
        rig.tick()

        assert rig.result == SUCCESS


class TestTolerances:
    def test_tolerances_via_actions(self, make_rig):
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

    def test_a_goal_can_switch_tolerances_off(self, make_rig):
        rig = make_rig(**PATH_TOLERANCES)
        rig.moves = False
        rig.goal(ONE_POINT, path_tolerance=[JointTolerance(f"j{i}", -1.0) for i in range(3)])
        rig.run(0.9)
        assert rig.result is None
        rig.place([1.0, 2.0, 3.0])
        rig.tick()

        assert rig.result == SUCCESS

    @pytest.mark.parametrize("tolerance", [JointTolerance("j0", -5.0), JointTolerance("j9", 1.0)])
    def test_bad_ones_fall_back_to_the_defaults(self, make_rig, tolerance, caplog):
        rig = make_rig(**PATH_TOLERANCES)
        rig.moves = False
        rig.goal(ONE_POINT, path_tolerance=[JointTolerance("j1", 99.0), tolerance])
        rig.tick(5)

        assert rig.result.code is ErrorCode.PATH_TOLERANCE_VIOLATED
        assert "the default tolerances are used" in caplog.text

    def test_state_tolerances_fail(self, make_rig):
        rig = make_rig(**PATH_TOLERANCES)
        rig.moves = False
        rig.goal([(1.0, [4.0, 5.0, 6.0])])
        rig.run(0.5)

        assert rig.result == aborted(
            ErrorCode.PATH_TOLERANCE_VIOLATED, "Aborted due to path tolerance violation"
        )
        assert rig.commanded().tolist() == rig.measured().tolist() == [0.0, 0.0, 0.0]

    def test_goal_tolerances_fail(self, make_rig):
        rig = make_rig(**GOAL_TOLERANCES, constraints__goal_time=0.05)
        rig.moves = False
        rig.goal(ONE_POINT)
        rig.run(1.0)

        assert rig.result == aborted(
            ErrorCode.GOAL_TOLERANCE_VIOLATED,
            "Aborted due to goal_time_tolerance exceeding by 0.060000 seconds",
        )
        assert rig.commanded().tolist() == [0.0, 0.0, 0.0]

    def test_without_a_goal_time_it_waits_for_ever(self, make_rig):
        rig = make_rig(**GOAL_TOLERANCES)
        rig.moves = False
        rig.goal(ONE_POINT)
        rig.run(20.0)
        assert rig.result is None

        rig.place([1.0, 2.0, 3.0])
        rig.tick()
        assert rig.result == SUCCESS

    def test_within_tolerance_in_time_is_success(self, make_rig):
        rig = make_rig(**GOAL_TOLERANCES, constraints__goal_time=0.5)
        rig.moves = False
        rig.goal(ONE_POINT)
        rig.run(0.8)
        rig.place([1.05, 2.0, 3.0])
        rig.tick()

        assert rig.result == SUCCESS

    def test_no_time_from_start_state_tolerance_fail(self, make_rig):
        rig = make_rig(**PATH_TOLERANCES)
        rig.moves = False
        rig.goal([(0.0, [4.0, 5.0, 6.0])])
        rig.tick()

        assert rig.result.code is ErrorCode.PATH_TOLERANCE_VIOLATED

    def test_the_log_names_the_joint(self, make_rig, caplog):
        rig = make_rig(constraints__j1__trajectory=0.01)
        rig.moves = False
        rig.goal([(1.0, [0.0, 5.0, 0.0])])
        rig.tick(2)

        assert "position error of joint j1 is 0.050000, tolerance 0.010000" in caplog.text

    def test_stopped_velocity_counts_where_velocity_is_commanded(self, make_rig):
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

    def test_stopped_velocity_does_not_count_where_only_positions_are(self, make_rig):
        rig = make_rig()
        rig.place([0.5, 0.0, 0.0], "velocity")
        rig.goal(ONE_POINT)
        rig.run(1.0)

        assert rig.result == SUCCESS


class TestEnd:
    def test_preempted_goal_receives_aborted_result(self, make_rig):
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

    def test_goals_of_one_cycle_preempt_each_other(self, make_rig):
        rig = make_rig()
        for name in ("first", "second", "third"):
            rig.goal(ONE_POINT, name)
        rig.tick()

        assert list(rig.sink.results) == ["first", "second"]

    def test_a_trajectory_on_the_topic_ends_the_goal(self, make_rig):
        rig = make_rig()
        rig.goal(ONE_POINT)
        rig.tick(10)
        rig.trajectory([(0.5, [-1.0, -1.0, -1.0])])
        rig.tick()

        assert rig.result == aborted(
            ErrorCode.INVALID_GOAL, "Current goal preempted by a trajectory on the topic."
        )

    def test_cancel_hold_position(self, make_rig):
        rig = make_rig()
        rig.goal([(1.0, [4.0, 5.0, 6.0])])
        rig.run(0.5)
        where = rig.measured()
        rig.controller.cancel_goal("goal")
        rig.tick()

        assert rig.result == GoalResult(GoalOutcome.CANCELED, ErrorCode.SUCCESSFUL, "")
        rig.run(1.0)
        assert rig.commanded().tolist() == where.tolist()

    def test_cancel_of_another_goal_changes_nothing(self, make_rig):
        rig = make_rig()
        rig.goal(ONE_POINT)
        rig.controller.cancel_goal("another")
        rig.run(1.0)

        assert rig.result == SUCCESS

    def test_cancel_after_the_end_changes_nothing(self, make_rig):
        rig = make_rig()
        rig.goal(ONE_POINT)
        rig.run(1.0)
        rig.controller.cancel_goal("goal")
        rig.tick()

        assert rig.result == SUCCESS
        assert rig.commanded().tolist() == [1.0, 2.0, 3.0]

    def test_cancel_in_the_cycle_of_the_start(self, make_rig):
        rig = make_rig()
        rig.goal(ONE_POINT)
        rig.controller.cancel_goal("goal")
        rig.run(1.0)

        assert rig.result.outcome is GoalOutcome.CANCELED
        assert rig.commanded().tolist() == [0.0, 0.0, 0.0]

    def test_cancel_works_while_paused(self, make_rig):
        rig = make_rig()
        rig.goal([(1.0, [4.0, 5.0, 6.0])])
        rig.run(0.5)
        rig.controller.cancel_goal("goal")
        rig.controller.serve_requests()

        assert rig.result.outcome is GoalOutcome.CANCELED

    def test_deactivate_controller_aborts_action(self, make_rig):
        rig = make_rig()
        rig.goal(ONE_POINT)
        rig.run(0.2)
        rig.deactivate()

        assert rig.result == aborted(
            ErrorCode.INVALID_GOAL, "Current goal cancelled during deactivate transition."
        )

    def test_deactivation_ends_goals_that_were_not_even_begun(self, make_rig):
        rig = make_rig()
        rig.goal(ONE_POINT, "first")
        rig.goal(ONE_POINT, "second")
        rig.deactivate()

        assert rig.sink.results["first"].message.startswith("Current goal preempted")
        assert rig.sink.results["second"].message.endswith("during deactivate transition.")
