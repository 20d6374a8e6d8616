"""A driver that for one cycle does not know where the joint is, just when that counts."""

from math import isnan, nan
from typing import Any

from arm_control.goal_outcome import Outcome

POSITION = "position_controllers/GripperActionController"


def test_a_cancel_holds_where_the_joint_was_last_seen(make_rig: Any) -> None:
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

    assert rig.result.outcome is Outcome.CANCELED
    assert rig.commanded() == 0.2


def test_an_activation_holds_where_the_joint_is_as_soon_as_that_is_known(make_rig: Any) -> None:
    rig = make_rig(POSITION, activate=False)
    rig.place(nan)
    rig.switch(on=True)
    rig.tick(3)
    assert isnan(rig.commanded())

    rig.place(0.2)
    rig.tick()
    rig.place(0.3)
    rig.tick()
    assert rig.commanded() == 0.2


def test_what_was_seen_before_an_activation_does_not_count(make_rig: Any) -> None:
    rig = make_rig(POSITION)
    rig.place(0.2)
    rig.tick()
    rig.switch(on=False)
    rig.place(nan)
    rig.switch(on=True)
    rig.tick()

    assert isnan(rig.commanded())
