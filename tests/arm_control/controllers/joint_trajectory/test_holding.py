"""When the controller aborts, times out, brakes or holds."""

import numpy as np
import pytest

from arm_control.controllers.joint_trajectory.goals import GoalOutcome, JointTolerance

MOVE = [(1.0, [1.0, 2.0, 3.0])]
BRAKES = {
    f"constraints__j{i}__max_deceleration_on_cancel": value
    for i, value in enumerate((1.0, 2.0, 4.0))
}


class TestTopicTrajectories:
    def test_state_tolerances_fail(self, make_rig, caplog):
        rig = make_rig(constraints__j1__trajectory=0.0001)
        rig.moves = False
        rig.trajectory(MOVE)
        rig.run(0.1)

        assert "Holding position due to state tolerance violation" in caplog.text
        assert rig.commanded().tolist() == [0.0, 0.0, 0.0]

    def test_goal_tolerances_fail(self, make_rig, caplog):
        rig = make_rig(constraints__j1__goal=0.1, constraints__goal_time=0.1)
        rig.moves = False
        rig.trajectory(MOVE)
        rig.run(1.1)
        assert rig.commanded().tolist() == [1.0, 2.0, 3.0]

        rig.run(0.1)
        assert "Exceeded goal_time_tolerance: holding position..." in caplog.text
        assert rig.commanded().tolist() == [0.0, 0.0, 0.0]

    def test_a_hold_checks_nothing(self, make_rig):
        rig = make_rig(constraints__j1__trajectory=0.0001)
        rig.moves = False
        rig.trajectory(MOVE)
        rig.run(0.1)
        rig.place([-3.3, 0.0, 0.0])
        rig.run(1.0)

        assert rig.commanded().tolist() == [0.0, 0.0, 0.0], "still the old place"


class TestTimeout:
    def test_accept_correct_cmd_timeout(self, make_rig, caplog):
        make_rig(cmd_timeout=3.0, constraints__goal_time=2.0)

        assert "cmd_timeout" not in caplog.text

    def test_decline_false_cmd_timeout(self, make_rig, caplog):
        rig = make_rig(cmd_timeout=1.0, constraints__goal_time=2.0)
        rig.trajectory(MOVE)
        rig.run(5.0)

        assert "must be greater than constraints.goal_time" in caplog.text
        assert "Aborted due to command timeout" not in caplog.text

    def test_no_timeout(self, make_rig):
        rig = make_rig()
        rig.trajectory(MOVE)
        rig.run(1.1)
        rig.moves = False
        rig.place([0.0, 0.0, 0.0])
        rig.run(60.0)

        assert rig.commanded().tolist() == [1.0, 2.0, 3.0]

    def test_timeout(self, make_rig, caplog):
        rig = make_rig(cmd_timeout=0.1)
        rig.trajectory(MOVE)
        rig.run(1.1)
        rig.moves = False
        rig.place([0.9, 1.9, 2.9])
        assert rig.commanded().tolist() == [1.0, 2.0, 3.0]

        rig.tick(2)
        assert "Aborted due to command timeout" in caplog.text
        assert rig.commanded().tolist() == [0.9, 1.9, 2.9]

    def test_a_goal_that_succeeded_has_no_timeout(self, make_rig):
        rig = make_rig(cmd_timeout=0.1)
        rig.goal(MOVE)
        rig.run(1.1)
        rig.moves = False
        rig.place([0.9, 1.9, 2.9])
        rig.run(1.0)

        assert rig.commanded().tolist() == [1.0, 2.0, 3.0]

    def test_a_goal_that_waits_is_not_ended_but_can_be_cancelled(self, make_rig):
        rig = make_rig(cmd_timeout=0.1, constraints__j0__goal=0.01)
        rig.moves = False
        rig.goal(MOVE)
        rig.run(2.0)
        assert not rig.sink.results
        assert rig.commanded().tolist() == [0.0, 0.0, 0.0]

        rig.controller.cancel_goal("goal")
        rig.tick()
        assert rig.result.outcome is GoalOutcome.CANCELED


class TestDeceleration:
    def test_cancel_decelerate_to_hold_position(self, make_rig, robot_description):
        rig = make_rig(
            constraints__decelerate_on_cancel=True, robot_description=robot_description(), **BRAKES
        )
        rig.goal(MOVE)
        rig.run(0.5)
        rig.place([1.0, 2.0, 3.0], "velocity")
        start = rig.measured()
        rig.controller.cancel_goal("goal")
        rig.tick()
        assert rig.result.outcome is GoalOutcome.CANCELED

        rig.place([0.0, 0.0, 0.0], "velocity")
        rig.run(2.0)
        # v² / 2a
        assert rig.commanded() == pytest.approx(start + np.array([0.5, 1.0, 1.125]))

    def test_each_joint_stops_in_its_own_time(self, make_rig, robot_description):
        rig = make_rig(
            commands=("position", "velocity"),
            constraints__decelerate_on_cancel=True,
            robot_description=robot_description(),
            **BRAKES,
        )
        rig.goal(MOVE)
        rig.run(0.5)
        rig.moves = False
        rig.place([1.0, -2.0, 2.0], "velocity")
        rig.controller.cancel_goal("goal")
        rig.tick()
        rig.run(0.49)

        assert rig.commanded("velocity") == pytest.approx([0.5, -1.0, 0.0])

    def test_a_trajectory_interrupts_it(self, make_rig, robot_description):
        rig = make_rig(
            constraints__decelerate_on_cancel=True, robot_description=robot_description(), **BRAKES
        )
        rig.goal(MOVE)
        rig.run(0.5)
        rig.place([1.0, 2.0, 3.0], "velocity")
        rig.controller.cancel_goal("goal")
        rig.run(0.1)
        rig.place([0.0, 0.0, 0.0], "velocity")
        rig.trajectory([(0.5, [0.0, 0.0, 0.0])])
        rig.run(0.6)

        assert rig.measured().tolist() == [0.0, 0.0, 0.0]

    @pytest.mark.parametrize(
        ("options", "lack"),
        [
            ({"constraints__j1__max_deceleration_on_cancel": 0.0}, "j1.max_deceleration_on_cancel"),
            ({"states": ("position",)}, "'velocity' state interface"),
            ({"robot_description": ""}, "velocity limit of joint j0"),
        ],
    )
    def test_fallback(self, make_rig, robot_description, options, lack, caplog):
        rig = make_rig(
            **{
                "constraints__decelerate_on_cancel": True,
                "robot_description": robot_description(),
                **BRAKES,
                **options,
            }
        )
        rig.goal(MOVE)
        rig.run(0.5)
        where = rig.measured()
        rig.controller.cancel_goal("goal")
        rig.run(1.0)

        assert lack in caplog.text
        assert rig.commanded().tolist() == where.tolist()


class TestQuery:
    def test_a_time_of_the_trajectory(self, make_rig):
        rig = make_rig()
        rig.trajectory([(1.0, [1.0, 2.0, 3.0])])
        rig.tick()
        start_s = rig.time_s
        rig.run(0.5)
        answer = rig.controller.query_state(start_s + 0.25)

        assert answer.success
        assert answer.motion == pytest.approx(
            np.array([[0.25, 0.5, 0.75], [1.0, 2.0, 3.0], [0.0, 0.0, 0.0]])
        )

    def test_moves_nothing(self, make_rig):
        rig = make_rig()
        rig.goal([(0.5, [1.0] * 3), (1.0, [2.0] * 3)])
        rig.run(0.3)
        rig.controller.query_state(rig.time_s + 0.7)
        rig.tick()

        assert rig.sink.state.reference[0, 0] == pytest.approx(0.6)
        assert rig.result is None

    def test_before_the_start_it_is_what_is_measured(self, make_rig):
        rig = make_rig()
        rig.trajectory([(1.0, [1.0, 2.0, 3.0])])
        rig.tick()
        rig.run(0.5)
        answer = rig.controller.query_state(rig.time_s - 0.6)

        assert not answer.success
        assert "before" in answer.message
        assert answer.motion[0] == pytest.approx([0.5, 1.0, 1.5])

    @pytest.mark.parametrize("later_s", [0.6, 1000.0])
    def test_after_the_end_it_is_the_last_point(self, make_rig, later_s):
        rig = make_rig()
        rig.trajectory([(1.0, [1.0, 2.0, 3.0], [0.0, 0.0, 0.0])])
        rig.tick()
        rig.run(0.5)
        answer = rig.controller.query_state(rig.time_s + later_s)

        assert not answer.success
        assert "after" in answer.message
        assert answer.motion == pytest.approx(np.array([[1.0, 2.0, 3.0], [0.0] * 3, [0.0] * 3]))

    def test_before_the_first_cycle(self, make_rig):
        assert "no trajectory" in make_rig().controller.query_state(0.0).message

    def test_while_not_active(self, make_rig):
        answer = make_rig(activate=False).controller.query_state(0.0)

        assert not answer.success
        assert answer.message == "the controller is not active"


class TestParametersThatChange:
    def test_update_dynamic_parameters(self, make_rig):
        rig = make_rig(commands=("effort",))
        rig.moves = False
        rig.trajectory([(0.0, [1.0, 1.0, 1.0])])
        rig.tick()
        assert rig.commanded("effort").tolist() == [0.0, 0.0, 0.0]

        rig.set(gains__j1__p=2.0)
        rig.tick()
        assert rig.commanded("effort").tolist() == [0.0, 2.0, 0.0]

    def test_update_dynamic_tolerances(self, make_rig):
        rig = make_rig()
        rig.moves = False
        rig.goal(MOVE)
        rig.run(0.5)
        assert rig.result is None

        rig.set(constraints__j0__trajectory=0.1)
        rig.tick()
        assert rig.result is not None

    def test_a_goals_own_tolerances_stay(self, make_rig):
        rig = make_rig()
        rig.moves = False
        rig.goal(MOVE, path_tolerance=[JointTolerance("j0", 0.9)])
        rig.run(0.5)
        rig.set(constraints__j0__trajectory=0.1)
        rig.tick()

        assert rig.result is None

    def test_rules(self, make_rig, make_request):
        rig = make_rig()
        partial = make_request([(1.0, [1.0])], ["j1"])
        assert rig.controller.check_goal(partial) is not None

        rig.set(allow_partial_joints_goal=True)
        assert rig.controller.check_goal(partial) is None
