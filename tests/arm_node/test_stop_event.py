"""The event that a signal handler may set."""

import gc
import os
import signal
import sys
import threading
import time
from collections.abc import Iterator

import pytest

from arm_node.process import StopEvent


@pytest.fixture
def event() -> Iterator[StopEvent]:
    """Return an event that SIGUSR1 sets."""
    event = StopEvent()
    previous = signal.signal(signal.SIGUSR1, lambda *_: event.set())
    yield event
    signal.signal(signal.SIGUSR1, previous)


def test_it_is_set_once_and_for_all(event):
    assert not event.is_set()
    assert not event.wait(0.0)
    event.set()
    event.set()
    assert event.is_set()
    assert event.wait()
    assert event.wait(0.0)


def test_a_time_out_is_waited_for(event):
    start_s = time.monotonic()
    assert not event.wait(0.05)
    assert time.monotonic() - start_s >= 0.05


def test_all_threads_that_wait_wake(event):
    woken: list[bool] = []
    threads = [threading.Thread(target=lambda: woken.append(event.wait(60.0))) for _ in range(3)]
    for thread in threads:
        thread.start()
    event.set()
    for thread in threads:
        thread.join(60.0)
    assert woken == [True] * 3


def test_a_signal_wakes_the_main_thread(event):
    threading.Timer(0.1, os.kill, (os.getpid(), signal.SIGUSR1)).start()
    assert event.wait(60.0)


def signal_at_each_line(event: StopEvent) -> Iterator[int]:
    """Wait again and again; each time the signal comes one line of Python later within `wait`."""
    for line_of_signal in range(1, 1000):
        lines = 0

        def trace(frame, kind, _argument, signal_at=line_of_signal):
            nonlocal lines
            if kind == "line":
                lines += 1
                if lines == signal_at:
                    signal.raise_signal(signal.SIGUSR1)
            return trace

        # A debugger's, or that of a measurement of coverage.
        usual = sys.gettrace()
        sys.settrace(trace)
        try:
            event.wait(0.0)
        finally:
            sys.settrace(usual)
        yield line_of_signal
        if lines < line_of_signal:
            return


def test_a_signal_in_the_midst_of_waiting_does_not_wait_for_itself(event):
    lines = list(signal_at_each_line(event))
    assert len(lines) > 2
    assert event.is_set()


def test_its_pipe_goes_with_it():
    before = len(os.listdir("/proc/self/fd"))
    event = StopEvent()
    assert len(os.listdir("/proc/self/fd")) == before + 2
    del event
    gc.collect()
    assert len(os.listdir("/proc/self/fd")) == before
