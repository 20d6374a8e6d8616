"""The loop goes before others only while it leaves them time."""

import logging
import os

import pytest

from arm_control.loop_priority import LoopPriority

PERIOD_S = 0.01


class Machine:
    """A processor whose time passes as a test says, and the schedulers asked of it."""

    def __init__(self, priority: int = 50, *, insist: bool = False, allowed: bool = True) -> None:
        self.wall_s = self.used_s = 0.0
        self.asked: list[tuple[int, int]] = []
        self.allowed = allowed
        self.loop = LoopPriority(
            priority,
            insist=insist,
            schedule=self._schedule,
            now_s=lambda: self.wall_s,
            used_s=lambda: self.used_s,
        )

    def _schedule(self, policy: int, priority: int) -> None:
        self.asked.append((policy, priority))
        if not self.allowed:
            raise PermissionError(1, "Operation not permitted")

    def run(
        self, seconds: float, used: float, *, wall: float = 1.0, planned: float = PERIOD_S
    ) -> None:
        """Tick for so many ticked seconds; a tick uses and lasts this share of its period."""
        for _ in range(round(seconds / PERIOD_S)):
            self.used_s += used * PERIOD_S
            self.wall_s += wall * PERIOD_S
            self.loop.note(PERIOD_S, planned)


RAISED = (os.SCHED_FIFO, 50)
LOWERED = (os.SCHED_OTHER, 0)


def test_a_loop_that_sleeps_most_of_the_time_is_raised_once() -> None:
    machine = Machine()
    machine.run(5.0, used=0.1)
    assert machine.asked == [RAISED]


def test_nothing_is_raised_before_a_second_was_seen() -> None:
    machine = Machine()
    machine.run(0.9, used=0.1)
    assert machine.asked == []


def test_a_loop_that_needs_too_much_is_lowered_and_raised_again_when_it_needs_less() -> None:
    machine = Machine()
    machine.run(2.0, used=0.1)
    machine.run(2.0, used=0.9)
    assert machine.asked == [RAISED, LOWERED]
    machine.run(2.0, used=0.1)
    assert machine.asked == [RAISED, LOWERED, RAISED]


def test_as_fast_as_possible_is_never_raised() -> None:
    machine = Machine()
    machine.run(5.0, used=0.004, wall=0.004, planned=0.0)
    assert machine.asked == []


def test_a_starved_loop_is_judged_by_what_its_ticks_need() -> None:
    """Whoever gets little of a busy machine needs no less when it goes first."""
    machine = Machine()
    machine.run(5.0, used=0.8, wall=3.0)
    assert machine.asked == []


def test_ticks_of_a_faster_clock_are_judged_by_wall_time() -> None:
    machine = Machine()
    machine.run(5.0, used=0.08, wall=0.1)
    assert machine.asked == []


def test_a_pause_ends_it() -> None:
    machine = Machine()
    machine.run(2.0, used=0.1)
    machine.loop.lower()
    machine.loop.lower()
    assert machine.asked == [RAISED, LOWERED]
    machine.run(0.9, used=0.1)
    assert machine.asked == [RAISED, LOWERED]


def test_priority_0_leaves_the_ordinary_scheduler() -> None:
    machine = Machine(0)
    machine.run(5.0, used=0.1)
    assert machine.asked == []


@pytest.mark.parametrize(("insist", "level"), [(True, logging.WARNING), (False, logging.DEBUG)])
def test_without_the_right_it_says_so_once(
    insist: bool, level: int, caplog: pytest.LogCaptureFixture
) -> None:
    caplog.set_level(logging.DEBUG)
    machine = Machine(insist=insist, allowed=False)
    machine.run(5.0, used=0.1)
    assert machine.asked == [RAISED]
    (record,) = caplog.records
    assert record.levelno == level
    assert record.message == (
        "the control loop runs without SCHED_FIFO priority 50: Operation not permitted"
    )
