"""The gate before each tick: who must answer, for how long it waits, and what happens then."""

import threading
from collections.abc import Callable, Iterator
from math import inf

import pytest

from arm_control.loop.control_loop import ControlLoop
from arm_control.loop.lock_step import NS_PER_S, LockStep
from arm_control.loop.pacer import Pacer
from arm_control.testing import ManualClock

TIMEOUT_S = 30.0


class Gate:
    """A lock-step with two partners, and a clock of the test's."""

    def __init__(self) -> None:
        self.clock = ManualClock(100.0)
        self.lock_step = LockStep(["/a", "/b"], 5.0, self.clock)

    def hear(self, partner: str, time_s: float) -> bool:
        return self.lock_step.record_answer(partner, round(time_s * NS_PER_S))

    def tick(self, time_s: float) -> None:
        assert self.lock_step.is_open()
        self.lock_step.end_tick(time_s)


@pytest.fixture
def gate() -> Gate:
    return Gate()


@pytest.fixture
def started(gate) -> Gate:
    """Both partners have said that they are there."""
    gate.hear("/a", 0.0)
    gate.hear("/b", 0.0)
    return gate


def test_the_first_tick_waits_until_every_partner_is_there(gate):
    assert not gate.lock_step.is_open()
    assert not gate.hear("/a", 0.0)
    assert not gate.lock_step.is_open()
    assert gate.hear("/b", 0.0)
    assert gate.lock_step.is_open()


def test_each_tick_waits_for_all_answers(started):
    started.tick(0.01)
    assert not started.lock_step.is_open()
    assert not started.hear("/a", 0.01)
    assert not started.lock_step.is_open()
    assert started.hear("/b", 0.01)
    assert started.lock_step.is_open()


def test_a_goal_that_the_loop_does_not_have_yet_holds_the_tick(started):
    started.tick(0.01)
    started.lock_step.hold()
    started.hear("/a", 0.01)
    started.hear("/b", 0.01)
    assert not started.lock_step.is_open(), "a partner that was told of it has answered"
    started.lock_step.release()
    assert started.lock_step.is_open()


def test_an_earlier_stamp_is_no_answer_and_a_later_one_is(started):
    started.tick(0.01)
    started.hear("/a", 0.01)
    assert not started.hear("/b", 0.0)
    assert not started.lock_step.is_open()
    assert started.hear("/b", 0.05)
    for number in (2, 3, 4, 5):
        started.tick(number * 0.01)
        started.hear("/a", number * 0.01)
    # The other one has answered until 0.05 s in advance.
    started.tick(0.06)
    started.hear("/a", 0.06)
    assert not started.lock_step.is_open()


def test_times_that_rounding_has_moved_are_the_same(started):
    started.tick(0.1 + 0.2)
    started.hear("/a", 0.3)
    started.hear("/b", 0.3)
    assert started.lock_step.is_open()


def test_a_silent_partner_is_named_after_the_time_out(started):
    started.tick(0.01)
    started.hear("/a", 0.01)
    assert started.lock_step.remaining_s() == 5.0
    started.clock.advance(4.0)
    assert started.lock_step.remaining_s() == 1.0
    started.clock.advance(1.0)
    assert started.lock_step.remaining_s() <= 0.0
    started.lock_step.give_up()
    assert "no answer from /b for the time 0.010 s within 5 s" in started.lock_step.failure


def test_one_that_was_given_up_comes_back_with_any_stamp(started):
    for number in range(1, 4):
        started.tick(number * 0.01)
        started.hear("/a", number * 0.01)
        if number < 3:
            started.hear("/b", number * 0.01)
    started.lock_step.give_up()
    assert not started.lock_step.is_open()
    # Another process, which has not seen the time yet.
    assert started.hear("/b", 0.0)
    assert started.lock_step.is_open()
    assert started.lock_step.failure == ""
    started.tick(0.04)
    assert not started.lock_step.is_open()


def test_a_pause_does_not_count(started):
    started.tick(0.01)
    started.lock_step.remaining_s()
    started.clock.advance(4.0)
    started.lock_step.pause_timeout()
    started.clock.advance(100.0)
    assert started.lock_step.remaining_s() == 5.0


def test_an_infinite_time_out_never_ends(started):
    started.lock_step.set_timeout(inf)
    started.tick(0.01)
    assert started.lock_step.remaining_s() == inf


def test_after_the_clock_was_set_back_old_answers_do_not_count(started):
    started.tick(10.0)
    started.hear("/a", 10.0)
    started.hear("/b", 10.0)
    started.tick(0.01)
    assert not started.lock_step.is_open()
    started.hear("/a", 0.01)
    started.hear("/b", 0.01)
    assert started.lock_step.is_open()


class Answering:
    """A loop whose ticks a partner answers at once, on a thread of its own, until it falls silent.

    Attributes:
        ticks: how many ticks have run.
    """

    def __init__(self, timeout_s: float, answers: int) -> None:
        self.ticks = 0
        self.lock_step = LockStep(["/partner"], timeout_s)
        self._answers = answers
        self._sent = threading.Semaphore(0)
        self.loop = ControlLoop(
            self._tick, Pacer(0.01, real_time_factor=0.0), lock_step=self.lock_step
        )
        self._thread = threading.Thread(target=self._answer, daemon=True)
        self._thread.start()

    def _tick(self) -> None:
        self.ticks += 1
        self.lock_step.end_tick(self.ticks * 0.01)
        self._sent.release()

    def _answer(self) -> None:
        for number in range(self._answers):
            if number:
                self._sent.acquire()
            if self.lock_step.record_answer("/partner", number * NS_PER_S // 100):
                self.loop.wake()


@pytest.fixture
def start() -> Iterator[Callable[..., Answering]]:
    made: list[Answering] = []

    def run(timeout_s: float, answers: int, *, paused: bool = False) -> Answering:
        made.append(Answering(timeout_s, answers))
        made[-1].loop.start(paused=paused)
        return made[-1]

    yield run
    for each in made:
        each.loop.stop()
        assert each.loop.join(TIMEOUT_S)


def wait_until_paused(loop: ControlLoop) -> None:
    while not loop.paused:
        # A call while the gate is closed is served at once.
        loop.call(lambda: None).result(TIMEOUT_S)


def test_the_loop_runs_a_tick_for_each_answer_and_pauses_in_silence(start):
    run = start(0.2, 500)
    wait_until_paused(run.loop)
    assert run.ticks == 500
    assert "no answer from /partner for the time 5.000 s" in run.lock_step.failure


def test_steps_wait_for_answers_too(start):
    run = start(0.2, 20, paused=True)
    assert run.loop.step(10).result(TIMEOUT_S) == 10
    assert run.loop.step(100).result(TIMEOUT_S) == 10
    assert run.ticks == 20
    assert run.loop.paused


def test_a_loop_that_waits_for_an_answer_ends_when_it_is_told(start):
    run = start(inf, 3)
    run.loop.call(lambda: None).result(TIMEOUT_S)
    run.loop.stop()
    assert run.loop.join(TIMEOUT_S)


def test_what_partners_have_sent_is_taken_before_the_tick(started):
    taken: list[str] = []
    started.lock_step.add_source(lambda: taken.append("first"))
    started.lock_step.add_source(lambda: taken.append("second"))
    started.lock_step.begin_tick()
    assert taken == ["first", "second"]
