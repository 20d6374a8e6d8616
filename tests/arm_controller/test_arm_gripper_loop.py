"""The loop of arm and gripper: its order, and that it logs actual results."""

import logging
from types import SimpleNamespace

import pytest

from arm_controller.arm_gripper_loop_controller_node import CLOSED, HOME, OPEN, TARGET, run_once


class FakeRobot:
    """Records its calls; movements to the positions in `blocked` fail."""

    def __init__(self, *blocked: object) -> None:
        self.did: list[object] = []
        self._blocked = blocked

    def connect(self) -> None:
        self.did.append("connect")

    def follow(self, path) -> str | None:
        (point,) = path
        assert (point.time_s, point.velocities) == (2.0, ())
        self.did.append(point.positions)
        return "a wall is there" if point.positions in self._blocked else None

    def grip(self, position: float, max_effort: float) -> SimpleNamespace:
        assert max_effort == 5.0
        self.did.append(position)
        is_blocked = position in self._blocked
        return SimpleNamespace(position=-0.3, reached_goal=not is_blocked, stalled=is_blocked)

    def pause(self, seconds: float) -> None:
        self.did.append("pause")


@pytest.fixture
def told(caplog):
    """Run the loop once; return the log records."""

    def run(robot: FakeRobot) -> list[tuple[str, str]]:
        with caplog.at_level(logging.INFO):
            run_once(robot, logging.getLogger(), 2.0, 5.0)
        return [(record.levelname, record.getMessage()) for record in caplog.records]

    return run


def test_a_round_is_target_close_home_open_with_pauses(told):
    robot = FakeRobot()
    said = told(robot)
    assert robot.did == [*("connect", TARGET, "pause", CLOSED), *(HOME, "pause", OPEN, "pause")]
    assert said == [
        ("INFO", "Moving to target position"),
        ("INFO", "Reached target position - Pausing"),
        ("INFO", "Closing gripper"),
        ("INFO", "Moving to home position"),
        ("INFO", "Reached home position - Pausing"),
        ("INFO", "Opening gripper"),
    ]


def test_a_position_that_was_not_reached_is_logged_and_the_loop_goes_on(told):
    robot = FakeRobot(TARGET, CLOSED)
    said = told(robot)
    assert ("ERROR", "Target position not reached: a wall is there") in said
    stopped = "Closing gripper: stopped at -0.300 rad, something is in the way"
    assert ("WARNING", stopped) in said
    assert not any("Reached target" in text for _, text in said)
    assert ("INFO", "Reached home position - Pausing") in said
