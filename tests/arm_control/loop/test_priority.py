"""The loop goes before others only while it leaves them time."""

import logging
import os

import pytest
from run_python import run_python

from arm_control.loop.priority import OTHERS_NICENESS, LoopPriority

PERIOD_S = 0.01


class Machine:
    """A processor with a manual clock, and the requested schedulers."""

    def __init__(
        self, priority: int = 50, *, warn_if_denied: bool = False, allowed: bool = True
    ) -> None:
        self.wall_s = self.used_s = 0.0
        self.asked: list[tuple[int, int]] = []
        self.allowed = allowed
        self.reniced: list[int] = []
        self.loop = LoopPriority(
            priority,
            warn_if_denied=warn_if_denied,
            schedule=self._schedule,
            renice_others=self.reniced.append,
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


def test_a_loop_that_sleeps_most_of_the_time_is_raised_once():
    machine = Machine()
    machine.run(5.0, used=0.1)
    assert machine.asked == [RAISED]


def test_nothing_is_raised_before_a_second_was_seen():
    machine = Machine()
    machine.run(0.9, used=0.1)
    assert machine.asked == []


def test_a_loop_that_needs_too_much_is_lowered_and_raised_again_when_it_needs_less():
    machine = Machine()
    machine.run(2.0, used=0.1)
    machine.run(2.0, used=0.9)
    assert machine.asked == [RAISED, LOWERED]
    machine.run(2.0, used=0.1)
    assert machine.asked == [RAISED, LOWERED, RAISED]


def test_as_fast_as_possible_is_never_raised():
    machine = Machine()
    machine.run(5.0, used=0.004, wall=0.004, planned=0.0)
    assert machine.asked == []


def test_a_starved_loop_is_judged_by_what_its_ticks_need():
    """A loop that gets little of a busy machine needs no less with a higher priority."""
    machine = Machine()
    machine.run(5.0, used=0.8, wall=3.0)
    assert machine.asked == []


def test_ticks_of_a_faster_clock_are_judged_by_wall_time():
    machine = Machine()
    machine.run(5.0, used=0.08, wall=0.1)
    assert machine.asked == []


def test_a_pause_ends_it():
    machine = Machine()
    machine.run(2.0, used=0.1)
    machine.loop.lower()
    machine.loop.lower()
    assert machine.asked == [RAISED, LOWERED]
    machine.run(0.9, used=0.1)
    assert machine.asked == [RAISED, LOWERED]


def test_priority_0_leaves_the_ordinary_scheduler():
    machine = Machine(0)
    machine.run(5.0, used=0.1)
    assert machine.asked == []


@pytest.mark.parametrize(
    ("warn_if_denied", "level"), [(True, logging.WARNING), (False, logging.DEBUG)]
)
def test_a_missing_right_is_logged_once(warn_if_denied, level, caplog):
    caplog.set_level(logging.DEBUG)
    machine = Machine(warn_if_denied=warn_if_denied, allowed=False)
    machine.run(5.0, used=0.1)
    assert machine.asked == [RAISED]
    (record,) = caplog.records
    assert record.levelno == level
    assert record.message == (
        "the control loop runs without SCHED_FIFO priority 50: Operation not permitted"
    )


def test_threads_that_share_locks_with_the_loop_get_a_larger_share_while_it_is_raised():
    """A thread that holds a lock and waits for a processor would delay the loop."""
    machine = Machine()
    machine.run(2.0, used=0.1)
    assert machine.reniced == [OTHERS_NICENESS]
    machine.run(2.0, used=0.9)
    assert machine.reniced == [OTHERS_NICENESS, -OTHERS_NICENESS]


def test_without_the_right_nobody_is_reniced():
    machine = Machine(allowed=False)
    machine.run(5.0, used=0.1)
    assert machine.reniced == []


def test_all_threads_but_the_calling_one_change_their_niceness():
    program = """
import os, threading
from arm_control.loop.priority import renice_other_threads
end, ready = threading.Event(), threading.Barrier(3)
def wait():
    ready.wait(30.0)
    end.wait(30.0)
others = [threading.Thread(target=wait) for _ in range(2)]
for thread in others:
    thread.start()
ready.wait(30.0)
before = os.getpriority(os.PRIO_PROCESS, 0)
renice_other_threads(3)
changed = [os.getpriority(os.PRIO_PROCESS, thread.native_id) - before for thread in others]
print(changed, os.getpriority(os.PRIO_PROCESS, 0) - before)
end.set()
"""
    run = run_python("-c", program, check=True)
    assert run.stdout == "[3, 3] 0\n"
