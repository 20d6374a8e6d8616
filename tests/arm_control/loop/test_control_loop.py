"""The loop thread: calls between ticks, pause, steps, failure, end."""

import os
import sys
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import CancelledError, wait
from typing import Any

import pytest

from arm_control.errors import ArmControlError, LoopStoppedError
from arm_control.loop.control_loop import ControlLoop
from arm_control.loop.outbox import MOST_TICKS, Outbox
from arm_control.loop.pacer import Pacer
from arm_control.loop.priority import LoopPriority
from arm_control.testing import ManualClock

TIMEOUT_S = 20.0


class Ticks:
    """Counts ticks and lets a test wait for them."""

    def __init__(self) -> None:
        self.count = 0
        self.threads: set[int] = set()
        self._changed = threading.Condition()

    def __call__(self) -> None:
        with self._changed:
            self.count += 1
            self.threads.add(threading.get_ident())
            self._changed.notify_all()

    def wait_for(self, count: int) -> None:
        with self._changed:
            assert self._changed.wait_for(lambda: self.count >= count, TIMEOUT_S)


@pytest.fixture
def ticks() -> Ticks:
    return Ticks()


@pytest.fixture
def start() -> Iterator[Callable[..., ControlLoop]]:
    """Return a function that starts a loop, which ends with the test."""
    loops: list[ControlLoop] = []

    def start_loop(
        tick: Callable[[], None], factor: float = 1.0, paused: bool = False, **options: Any
    ) -> ControlLoop:
        loop = ControlLoop(tick, Pacer(0.002, real_time_factor=factor), **options)
        loops.append(loop)
        loop.start(paused=paused)
        return loop

    yield start_loop
    for loop in loops:
        loop.stop()
        assert loop.join(TIMEOUT_S)


@pytest.mark.parametrize("factor", [0.0, 1.0])
def test_it_ticks_on_its_own_thread(start, ticks, factor):
    start(ticks, factor)
    ticks.wait_for(20)
    assert len(ticks.threads) == 1
    assert threading.get_ident() not in ticks.threads


@pytest.mark.parametrize("paused", [True, False])
@pytest.mark.parametrize("factor", [0.0, 1.0])
def test_a_call_runs_on_the_loop_thread(start, ticks, factor, paused):
    loop = start(ticks, factor, paused=paused)
    thread = loop.call(threading.get_ident).result(TIMEOUT_S)
    loop.step() if paused else None
    ticks.wait_for(1)
    assert ticks.threads == {thread}


def test_a_call_does_not_wait_for_a_distant_deadline(ticks):
    loop = ControlLoop(ticks, Pacer(3600.0))
    loop.start()
    ticks.wait_for(1)
    assert loop.call(lambda: 7).result(TIMEOUT_S) == 7
    assert ticks.count == 1
    loop.stop()
    assert loop.join(TIMEOUT_S)


def test_calls_run_in_the_order_they_came(start, ticks):
    loop = start(ticks)
    order: list[int] = []
    futures = [loop.call(lambda i=i: order.append(i)) for i in range(50)]
    for future in futures:
        future.result(TIMEOUT_S)
    assert order == list(range(50))


def test_a_call_that_comes_before_the_start_waits_for_it(ticks):
    loop = ControlLoop(ticks, Pacer(0.002))
    future = loop.call(lambda: "early")
    loop.start(paused=True)
    assert future.result(TIMEOUT_S) == "early"
    loop.stop()
    assert loop.join(TIMEOUT_S)


def test_what_a_call_raises_is_the_callers(start, ticks):
    loop = start(ticks)

    def broken() -> None:
        raise KeyError("mine")

    with pytest.raises(KeyError, match="mine"):
        loop.call(broken).result(TIMEOUT_S)
    ticks.wait_for(ticks.count + 3)


def test_a_call_that_wants_to_end_the_process_ends_nothing(start, ticks):
    loop = start(ticks)
    with pytest.raises(ArmControlError, match="raised SystemExit: 3"):
        loop.call(lambda: sys.exit(3)).result(TIMEOUT_S)
    ticks.wait_for(ticks.count + 3)


def test_a_cancelled_call_is_skipped(start, ticks):
    loop = start(ticks, paused=True)
    release = threading.Event()
    loop.call(lambda: release.wait(TIMEOUT_S))
    ran: list[int] = []
    future = loop.call(lambda: ran.append(1))
    assert future.cancel()
    release.set()
    loop.call(lambda: None).result(TIMEOUT_S)
    assert ran == []
    with pytest.raises(CancelledError):
        future.result(0)


def test_callers_that_keep_coming_do_not_hold_up_the_ticks(start, ticks):
    loop = start(ticks, 0.0)

    def again() -> None:
        if ticks.count < 100:
            loop.call(again)

    loop.call(again)
    ticks.wait_for(100)
    assert ticks.count >= 100


# Pause and steps


def test_time_stands_still_while_paused(start, ticks):
    loop = start(ticks, 0.0)
    ticks.wait_for(5)
    loop.pause().result(TIMEOUT_S)
    count = ticks.count
    for _ in range(20):
        loop.call(lambda: None).result(TIMEOUT_S)
    assert loop.paused
    assert ticks.count == count


def test_it_can_start_paused(start, ticks):
    loop = start(ticks, 0.0, paused=True)
    loop.call(lambda: None).result(TIMEOUT_S)
    assert ticks.count == 0


def test_resume_lets_time_go_on(start, ticks):
    loop = start(ticks, paused=True)
    loop.resume().result(TIMEOUT_S)
    ticks.wait_for(3)
    assert not loop.paused


def test_steps_run_while_paused(start, ticks):
    loop = start(ticks, paused=True)
    assert loop.step(7).result(TIMEOUT_S) == 7
    assert ticks.count == 7
    assert loop.paused


def test_steps_do_not_wait_for_the_clock(ticks):
    loop = ControlLoop(ticks, Pacer(3600.0))
    loop.start(paused=True)
    assert loop.step(5).result(TIMEOUT_S) == 5
    loop.stop()
    assert loop.join(TIMEOUT_S)


def test_calls_are_served_between_steps(start, ticks):
    loop = start(ticks, paused=True)
    steps = loop.step(10_000_000)
    seen = loop.call(lambda: ticks.count).result(TIMEOUT_S)
    assert seen < 10_000_000
    loop.resume().result(TIMEOUT_S)
    assert 0 <= steps.result(TIMEOUT_S) < 10_000_000


def test_a_pause_ends_steps(start, ticks):
    loop = start(ticks, paused=True)
    steps = loop.step(10_000_000)
    ticks.wait_for(1)
    assert loop.stepping
    loop.pause().result(TIMEOUT_S)
    assert 0 <= steps.result(TIMEOUT_S) < 10_000_000
    assert loop.paused
    assert not loop.stepping


def test_cancelling_steps_drops_those_not_yet_done(start, ticks):
    loop = start(ticks, paused=True)
    steps = loop.step(10_000_000)
    ticks.wait_for(1)
    following = loop.step(2)
    assert steps.cancel()
    assert following.result(TIMEOUT_S) == 2
    assert not loop.stepping
    count = ticks.count
    loop.resume().result(TIMEOUT_S)
    ticks.wait_for(count + 3)


@pytest.mark.parametrize("end", [ControlLoop.pause, ControlLoop.resume, ControlLoop.stop])
def test_steps_cancelled_before_they_begin_are_not_run(start, ticks, caplog, end):
    loop = start(ticks, paused=True)
    release = threading.Event()
    loop.call(lambda: release.wait(TIMEOUT_S))
    steps = loop.step(2), loop.step(0)
    end(loop)
    assert all(future.cancel() for future in steps)
    release.set()
    done = wait(steps, TIMEOUT_S).done
    assert done == set(steps)
    if end is not ControlLoop.stop:
        assert loop.call(lambda: "alive").result(TIMEOUT_S) == "alive"
    assert not caplog.records


def test_step_requests_follow_one_another(start, ticks):
    loop = start(ticks, paused=True)
    first, second = loop.step(3), loop.step(4)
    assert (first.result(TIMEOUT_S), second.result(TIMEOUT_S)) == (3, 4)
    assert ticks.count == 7


def test_steps_need_a_pause(start, ticks):
    loop = start(ticks)
    with pytest.raises(ValueError, match="pause it first"):
        loop.step(1).result(TIMEOUT_S)


def test_the_number_of_steps_must_be_positive(start, ticks):
    loop = start(ticks, paused=True)
    with pytest.raises(ValueError, match="must be positive, not 0"):
        loop.step(0).result(TIMEOUT_S)


# The end


def test_stop_ends_the_thread(start, ticks):
    loop = start(ticks)
    assert loop.running
    loop.stop()
    assert loop.join(TIMEOUT_S)
    assert not loop.running


def test_stop_ends_a_paused_loop(start, ticks):
    loop = start(ticks, paused=True)
    loop.stop()
    assert loop.join(TIMEOUT_S)


def test_a_call_after_the_end_is_refused(start, ticks):
    loop = start(ticks)
    loop.stop()
    loop.join(TIMEOUT_S)
    with pytest.raises(LoopStoppedError):
        loop.call(lambda: None).result(0)
    with pytest.raises(LoopStoppedError):
        loop.step().result(0)


def test_a_call_that_waits_when_the_loop_ends_is_refused(start, ticks):
    loop = start(ticks, paused=True)
    release = threading.Event()
    loop.call(lambda: release.wait(TIMEOUT_S))
    loop.stop()
    left_over = loop.call(lambda: None)
    release.set()
    with pytest.raises(LoopStoppedError):
        left_over.result(TIMEOUT_S)


def test_steps_not_run_at_the_end_are_reported(start, ticks):
    loop = start(ticks, paused=True)
    steps = loop.step(10_000_000)
    loop.stop()
    assert steps.result(TIMEOUT_S) < 10_000_000


@pytest.mark.parametrize("kind", [RuntimeError, SystemExit])
def test_a_tick_that_raises_ends_the_loop_with_its_reason(start, caplog, kind):
    failures: list[BaseException] = []

    def broken() -> None:
        raise kind("unstable")

    loop = start(broken, on_failure=failures.append)
    assert loop.join(TIMEOUT_S)
    assert [str(failure) for failure in failures] == ["unstable"]
    assert not loop.running
    assert "the control loop ends: a tick failed" in caplog.text
    with pytest.raises(LoopStoppedError):
        loop.call(lambda: None).result(0)


def test_its_thread_is_raised_while_it_paces_and_lowered_while_it_does_not(start, ticks):
    asked: list[tuple[int, int]] = []

    def schedule(policy: int, priority: int) -> None:
        asked.append((policy, threading.get_ident()))

    loop = start(ticks, priority=LoopPriority(50, schedule=schedule, used_s=lambda: 0.0))
    ticks.wait_for(600)
    loop.pause().result(TIMEOUT_S)
    (thread,) = ticks.threads
    assert asked == [(os.SCHED_FIFO, thread), (os.SCHED_OTHER, thread)]


class Publisher:
    """A tick that publishes its number through an outbox that time does not press."""

    def __init__(self) -> None:
        self.outbox = Outbox(ManualClock())
        self.sent: list[int] = []
        self.most_together = 0
        self.count = 0
        self.done = threading.Event()

    def __call__(self) -> None:
        number = self.count
        self.outbox.put(lambda _: self.sent.append(number), b"")
        self.most_together = max(self.most_together, number - len(self.sent))
        self.count += 1
        if self.count == 50:
            self.done.set()


@pytest.mark.parametrize("factor", [0.0, 1.0])
def test_everything_is_published_before_a_pause_returns(start, factor):
    tick = Publisher()
    loop = start(tick, factor, outbox=tick.outbox)
    for _ in range(50):
        loop.resume().result(TIMEOUT_S)
        loop.pause().result(TIMEOUT_S)
        count = loop.call(lambda: tick.count).result(TIMEOUT_S)
        assert tick.sent == list(range(count))


def test_steps_are_published_before_the_wait_for_them_returns(start):
    tick = Publisher()
    loop = start(tick, paused=True, outbox=tick.outbox)
    for count in (1, 2, MOST_TICKS, 2 * MOST_TICKS + 1):
        before = len(tick.sent)
        loop.step(count).result(TIMEOUT_S)
        assert len(tick.sent) == before + count


def test_ticks_that_follow_at_once_are_published_together(start):
    tick = Publisher()
    loop = start(tick, factor=0.0, outbox=tick.outbox)
    assert tick.done.wait(TIMEOUT_S)
    loop.pause().result(TIMEOUT_S)
    assert tick.most_together == MOST_TICKS - 1
