"""A driver that does not know where the joint is, for one cycle or permanently."""

from math import isnan, nan

import pytest

from arm_control.controllers.goals import GoalOutcome

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
