"""What the thread takes from an arm: no jumps that no joint can make."""

import logging

import numpy as np
import pytest

from arm_drivers.arm_device import ArmReading
from arm_drivers.errors import DriverError
from arm_drivers.exchange_thread import ExchangeThread
from arm_drivers.goals import GoalTracker

LIMIT = np.full(1, 3.0)


class ScriptedArm:
    """Reports the given positions, then the last one for good."""

    names = ("elbow",)
    lower = -LIMIT
    upper = LIMIT
    max_speed = 1.0

    def __init__(self, *positions: float) -> None:
        self.positions = list(positions)

    def exchange(self, goals: object) -> ArmReading:
        value = self.positions.pop(0) if len(self.positions) > 1 else self.positions[0]
        return ArmReading(np.array([value]), np.zeros(1), np.zeros(1))


def thread_of(arm: ScriptedArm, times: list[float]) -> ExchangeThread:
    goals = GoalTracker(arm.names, arm.lower, arm.upper, 1.0, lambda: times[-1])
    return ExchangeThread(arm, goals, logging.getLogger("test"), max_missed=3, watchdog_s=1.0)


def test_a_jump_counts_as_missed_until_there_was_time_for_it():
    times = [0.0]
    thread = thread_of(ScriptedArm(0.5, 2.0), times)
    for now_s, position in ((0.01, 0.5), (0.02, 0.5), (2.0, 2.0)):
        times.append(now_s)
        thread.exchange()
        assert thread.latest.positions.tolist() == [position]
    assert thread.missed.tolist() == [2]


def test_an_arm_that_does_not_report_is_refused():
    with pytest.raises(DriverError, match="the arm did not answer"):
        thread_of(ScriptedArm(np.nan), [0.0])
