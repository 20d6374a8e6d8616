"""The steps of a pick: their order, the log, and where it ends if one fails."""

import logging

import pytest
from control_msgs.action import GripperCommand

from arm_controller.pick_and_place_node import PickAndPlace, PickError
from arm_controller.pick_plan import CLOSED, WIDE_OPEN, JointPath, PickPlan, PickTask, path_to

NAMES = ("to_object", "approach", "up", "down", "away", "home")
PLAN = PickPlan(
    PickTask(max_effort=2.0), **{name: path_to((float(n),), 1.0) for n, name in enumerate(NAMES)}
)


def result(position: float, reached: bool, stalled: bool) -> GripperCommand.Result:
    return GripperCommand.Result(position=position, reached_goal=reached, stalled=stalled)


HELD = result(-0.25, reached=False, stalled=True)
OPEN = result(WIDE_OPEN, reached=True, stalled=False)


class FakeRobot:
    """Records its calls; `grips` are the results of closing, one after the other."""

    def __init__(
        self,
        *grips: GripperCommand.Result | str,
        blocked: str = "",
        opening: GripperCommand.Result | str = OPEN,
    ) -> None:
        self.did: list[object] = []
        self._grips = list(grips)
        self._blocked = blocked
        self._opening = opening

    def connect(self) -> None:
        self.did.append("connect")

    def follow(self, path: JointPath) -> str | None:
        name = NAMES[int(path[0].positions[0])]
        self.did.append(name)
        return "a wall is there" if name == self._blocked else None

    def grip(self, position: float, max_effort: float) -> GripperCommand.Result | str:
        assert max_effort == 2.0
        self.did.append(position)
        return self._opening if position == WIDE_OPEN else self._grips.pop(0)

    def pause(self, seconds: float) -> None:
        self.did.append(seconds)


def run(robot: FakeRobot) -> None:
    PickAndPlace(robot, PLAN, logging.getLogger()).run()


def test_the_object_is_picked_held_and_put_back(caplog):
    robot = FakeRobot(HELD, HELD)
    with caplog.at_level(logging.INFO):
        run(robot)
    assert robot.did == [
        *("connect", WIDE_OPEN, "to_object", "approach", CLOSED, "up", 5.0, CLOSED),
        *("down", WIDE_OPEN, "away", "home"),
    ]
    said = [record.getMessage() for record in caplog.records]
    assert said[3:7] == [
        "Closing gripper",
        "The object is held, at -0.250 rad",
        "Moving up by 0.1 m",
        "Holding for 5 s",
    ]
    assert said[-1] == "The object was picked up, held and put back"


@pytest.mark.parametrize(
    ("robot", "message", "last"),
    [
        (FakeRobot(HELD, blocked="up"), "could not move up by 0.1 m: a wall is there", "up"),
        (FakeRobot(result(CLOSED, True, False)), "nothing between the fingers", CLOSED),
        (FakeRobot(HELD, result(CLOSED, True, False)), "nothing between the fingers", CLOSED),
        (FakeRobot(result(-0.1, False, False)), "the grip ended at -0.100 rad", CLOSED),
        (FakeRobot("its action server is gone"), "did not move: its action server", CLOSED),
        (FakeRobot(opening=result(0.02, False, True)), "did not open: it is at 0.020", WIDE_OPEN),
    ],
)
def test_a_failed_step_is_the_last_and_is_reported(robot, message, last):
    with pytest.raises(PickError, match=message):
        run(robot)
    assert robot.did[-1] == last
