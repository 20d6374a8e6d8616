"""A driver that does not know where a joint is, for one cycle or permanently."""

from typing import Any

import numpy as np
import pytest

from arm_control.controllers.goals import GoalOutcome
from arm_control.controllers.joint_trajectory.goals import ErrorCode

STAND = (0.5, 0.5, 0.5)
MOVE = [(2.0, [0.6, 0.6, 0.6])]
BRAKES = {
    "constraints__decelerate_on_cancel": True,
    **{f"constraints__j{i}__max_deceleration_on_cancel": 1.0 for i in range(3)},
}


def tick_blindly(rig: Any, kind: str = "position") -> None:
    """Run one cycle in which j1 reads NaN; the robot does not move."""
    before = rig.measured(kind)
    rig.place([before[0], np.nan, before[2]], kind)
    moves, rig.moves = rig.moves, False
    rig.tick()
    rig.moves = moves
    rig.place(before, kind)


class TestBeginning:
    @pytest.mark.parametrize("options", [{}, {"interpolation_method": "none"}])
    def test_starts_from_what_was_commanded_last(self, make_rig, options):
        rig = make_rig(positions=STAND, **options)
        rig.tick()
        rig.goal(MOVE)
        tick_blindly(rig)
        rig.tick()

        assert rig.commanded() == pytest.approx([0.5] * 3, abs=0.005)

    def test_joints_that_are_not_named_stay(self, make_rig):
        rig = make_rig(
            commands=("velocity",),
            positions=STAND,
            allow_partial_joints_goal=True,
            gains__j1__p=1.0,
        )
        rig.moves = False
        rig.tick()
        rig.goal([(1.0, [0.6])], joints=["j0"])
        tick_blindly(rig)
        rig.tick()

        assert rig.sink.state.reference[0, 1] == 0.5
        assert rig.commanded("velocity")[1] == 0.0

    def test_the_answer_to_a_query_hides_nothing(self, make_rig):
        rig = make_rig(positions=STAND)
        tick_blindly(rig)

        measured = rig.controller.query_state(rig.time_s + 9.0).motion[0]
        assert np.isnan(measured).tolist() == [False, True, False]


class TestActivation:
    @pytest.fixture
    def rig(self, make_rig):
        """Return a rig that was activated before its hardware knew anything."""
        rig = make_rig(positions=(np.nan,) * 3)
        rig.moves = False
        rig.tick(3)
        return rig

    def test_holds_the_positions_as_soon_as_they_are_known(self, rig):
        assert np.isnan(rig.commanded()).all()

        rig.place(STAND)
        rig.tick()
        assert rig.commanded().tolist() == list(STAND)

        rig.place([9.0] * 3)
        rig.tick()
        assert rig.commanded().tolist() == list(STAND)

    def test_a_goal_waits_until_that_is_known(self, rig):
        rig.goal(MOVE)
        rig.run(0.5)
        assert np.isnan(rig.commanded()).all()
        assert rig.result is None

        rig.place(STAND)
        rig.tick()
        rig.moves = True
        rig.run(1.0)
        assert rig.commanded() == pytest.approx([0.55] * 3, abs=0.001)


class TestStopping:
    def test_a_cancel_holds_the_last_command(self, make_rig):
        rig = make_rig(positions=STAND)
        rig.goal(MOVE)
        rig.run(1.0)
        before = rig.commanded()
        rig.controller.cancel_goal("goal")
        tick_blindly(rig)
        rig.run(1.0)

        assert rig.commanded() == pytest.approx(before, abs=0.001)

    def test_so_does_a_tolerance_that_is_violated(self, make_rig):
        rig = make_rig(positions=STAND, constraints__j1__trajectory=0.1)
        rig.goal(MOVE)
        rig.run(1.0)
        before = rig.commanded()
        tick_blindly(rig)
        rig.run(1.0)

        assert rig.result is not None
        assert rig.commanded() == pytest.approx(before, abs=0.001)

    def test_so_does_a_time_out(self, make_rig, caplog):
        rig = make_rig(positions=STAND, cmd_timeout=0.1)
        rig.trajectory(MOVE)
        while "Aborted due to command timeout" not in caplog.text:
            tick_blindly(rig)
            assert rig.time_s < 20.0
        rig.run(1.0)

        assert rig.commanded().tolist() == [0.5, 0.6, 0.5]

    @pytest.mark.parametrize("kind", ["position", "velocity"])
    def test_braking_while_unmeasured_does_not_end_at_nan(self, make_rig, robot_description, kind):
        rig = make_rig(positions=STAND, robot_description=robot_description(), **BRAKES)
        rig.goal(MOVE)
        rig.run(1.0)
        before = rig.commanded()
        rig.controller.cancel_goal("goal")
        tick_blindly(rig, kind)
        rig.run(1.0)

        assert rig.commanded() == pytest.approx(before, abs=0.01)


class TestGoals:
    """No goal succeeds on a state that is not a number."""

    @pytest.mark.parametrize("kind", ["position", "velocity"])
    def test_a_goal_is_aborted_and_names_the_state(self, make_rig, kind):
        rig = make_rig(positions=STAND)
        rig.goal(MOVE)
        rig.run(1.0)
        rig.moves = False
        rig.place([0.0, np.nan, 0.0], kind)
        rig.run(1.5)

        assert rig.result.code is ErrorCode.GOAL_TOLERANCE_VIOLATED
        assert rig.result.outcome is GoalOutcome.ABORTED
        sentence = f"state j1/{kind} is not a number, so the goal cannot be checked"
        assert sentence in rig.result.message

    def test_a_goal_with_time_to_spare_waits_that_long(self, make_rig):
        rig = make_rig(positions=STAND, constraints__goal_time=1.0)
        rig.goal(MOVE)
        rig.run(1.9)
        moved = rig.measured()
        rig.place([np.nan] * 3)
        rig.moves = False
        rig.run(0.5)
        assert rig.result is None

        rig.place(moved)
        rig.moves = True
        rig.tick(2)
        assert rig.result.code is ErrorCode.SUCCESSFUL

    def test_the_time_to_spare_ends(self, make_rig):
        rig = make_rig(positions=STAND, constraints__goal_time=1.0)
        rig.goal(MOVE)
        rig.run(1.9)
        rig.place([np.nan] * 3)
        rig.moves = False
        rig.run(1.3)
        assert rig.result.outcome is GoalOutcome.ABORTED
        assert "states j0/position, j1/position, j2/position are not numbers" in rig.result.message

    def test_a_violated_path_names_the_unmeasured_states(self, make_rig):
        rig = make_rig(positions=STAND, constraints__j1__trajectory=0.1)
        rig.goal(MOVE)
        rig.run(1.0)
        tick_blindly(rig)

        assert rig.result.code is ErrorCode.PATH_TOLERANCE_VIOLATED
        assert "state j1/position is not a number" in rig.result.message

    def test_a_goal_that_waits_for_a_position_is_logged(self, make_rig, caplog):
        rig = make_rig(positions=(0.1, np.nan, 0.1))
        rig.moves = False
        rig.tick()
        rig.goal(MOVE)
        rig.tick()
        assert "state j1/position is not a number: the motion starts as soon as" in caplog.text
