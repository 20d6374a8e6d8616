"""Timers, readers and signals of the supervisor's loop."""

import math
import os
import signal

import pytest

from launch_py.supervision.event_loop import EventLoop
from launch_py.testing import FakeClock


@pytest.fixture
def loop():
    loop = EventLoop()
    yield loop
    loop.close()


def test_timers_are_called_in_their_order():
    clock = FakeClock()
    loop = EventLoop(clock)
    called = []
    loop.call_later(2.0, lambda: called.append("late"))
    loop.call_later(1.0, lambda: called.append("first"))
    loop.call_later(1.0, lambda: called.append("second"))
    loop.call_later(1.0, lambda: called.append("never")).cancel()
    clock.advance(1.0)
    loop.call_due_timers()
    assert called == ["first", "second"]
    clock.advance(1.0)
    loop.call_due_timers()
    assert called == ["first", "second", "late"]
    loop.close()


def test_run_waits_for_a_timer(loop):
    called = []
    loop.call_later(0.01, lambda: called.append("timer"))
    loop.run(until=lambda: bool(called))
    assert called == ["timer"]


@pytest.mark.parametrize("delay_s", [math.inf, 1e15])
def test_a_timer_may_never_be_due(loop, delay_s):
    called = []
    loop.call_later(delay_s, lambda: called.append("never"))
    readable, writable = os.pipe()
    loop.add_reader(readable, lambda: called.append(os.read(readable, 10)))
    os.write(writable, b"x")
    loop.run(until=lambda: bool(called))
    os.close(readable)
    os.close(writable)
    assert called == [b"x"]


def test_run_waits_for_a_file(loop):
    readable, writable = os.pipe()
    received = []
    loop.add_reader(readable, lambda: received.append(os.read(readable, 10)))
    os.write(writable, b"x")
    loop.run(until=lambda: bool(received))
    loop.remove_reader(readable)
    os.close(readable)
    os.close(writable)
    assert received == [b"x"]


def test_a_reader_may_remove_another(loop):
    pipes = [os.pipe() for _ in range(2)]
    called = []

    def remove_all(index):
        called.append(index)
        for readable, _ in pipes:
            loop.remove_reader(readable)

    for index, (readable, writable) in enumerate(pipes):
        loop.add_reader(readable, lambda i=index: remove_all(i))
        os.write(writable, b"x")
    loop.run(until=lambda: bool(called))
    assert len(called) == 1
    for pipe in pipes:
        os.close(pipe[0])
        os.close(pipe[1])


def test_a_file_that_reuses_a_removed_one_s_number_is_distinct(loop):
    pipes = [os.pipe() for _ in range(2)]
    called = []

    def replace_other(index):
        called.append(index)
        other, _ = pipes[1 - index]
        loop.remove_reader(other)
        replacement, writable = os.pipe()
        os.dup2(replacement, other)
        os.close(replacement)
        loop.add_reader(other, lambda: called.append("replacement"))
        pipes.append((pipes[1 - index][0], writable))

    for index, (readable, writable) in enumerate(pipes):
        loop.add_reader(readable, lambda i=index: replace_other(i))
        os.write(writable, b"x")
    loop.run(until=lambda: bool(called))
    assert len(called) == 1
    for fd in {fd for pipe in pipes for fd in pipe}:
        os.close(fd)


def test_signals_come_from_the_loop_and_the_handlers_are_restored(loop):
    before = signal.getsignal(signal.SIGUSR1)
    called = []
    with loop.signals({signal.SIGUSR1: lambda: called.append(1)}):
        os.kill(os.getpid(), signal.SIGUSR1)
        assert called == []
        loop.run(until=lambda: bool(called))
    assert signal.getsignal(signal.SIGUSR1) is before


def test_simultaneous_signals_are_handled_once_each(loop):
    called = []
    names = {signal.SIGUSR1: "first", signal.SIGUSR2: "second"}
    with loop.signals({number: lambda n=name: called.append(n) for number, name in names.items()}):
        for number in (signal.SIGUSR1, signal.SIGUSR2) * 3:
            signal.raise_signal(number)
        loop.run(until=lambda: len(called) >= 2)
        loop.call_later(0.0, lambda: called.append("end"))
        loop.run(until=lambda: "end" in called)
    assert called == ["first", "second", "end"]
