"""The thread of an executor: what it logs of failures, and its order of shutdown."""

import threading
from collections.abc import Callable, Iterator

import pytest
import rclpy
from rclpy.context import Context
from rclpy.executors import Executor, MultiThreadedExecutor, SingleThreadedExecutor
from rclpy.signals import SignalHandlerOptions

from arm_node.executor_thread import ExecutorThread

TIMEOUT_S = 30.0
TURNS = 100


@pytest.fixture(scope="module")
def context() -> Iterator[Context]:
    """Return a context without any node: nothing is sent."""
    context = Context()
    rclpy.init(context=context, signal_handler_options=SignalHandlerOptions.NO)
    yield context
    context.try_shutdown()


def raise_key_error() -> None:
    raise KeyError("j9")


def run(executor: Executor, function: Callable[[], object]) -> threading.Event:
    """Run a function on an executor; the event is set afterwards."""
    done = threading.Event()
    executor.create_task(function).add_done_callback(lambda _: done.set())
    return done


def test_a_failure_is_logged_once_and_the_executor_goes_on(context, caplog):
    thread = ExecutorThread("spin", SingleThreadedExecutor(context=context))
    thread.start()
    for _ in range(3):
        assert run(thread.executor, raise_key_error).wait(TIMEOUT_S)
    assert run(thread.executor, lambda: None).wait(TIMEOUT_S)
    thread.stop()
    assert [record.getMessage() for record in caplog.records] == [
        "a callback failed; the node goes on"
    ]
    assert "KeyError: 'j9'" in caplog.text


class WatchfulExecutor(SingleThreadedExecutor):
    """Notes which threads are there when it is shut down."""

    threads: tuple[str, ...] = ()

    def shutdown(self, timeout_sec: float | None = None) -> bool:
        self.threads = tuple(thread.name for thread in threading.enumerate())
        return super().shutdown(timeout_sec)


def test_what_the_thread_waits_for_goes_after_the_thread(context):
    executor = WatchfulExecutor(context=context)
    thread = ExecutorThread("spin", executor)
    thread.start()
    assert run(executor, lambda: None).wait(TIMEOUT_S)
    thread.stop()
    assert executor.threads
    assert "spin" not in executor.threads


@pytest.mark.parametrize("make", [SingleThreadedExecutor, MultiThreadedExecutor])
def test_an_executor_that_is_woken_at_the_end_ends_without_a_failure(context, caplog, make):
    for _ in range(TURNS):
        thread = ExecutorThread("spin", make(context=context))
        thread.start()
        assert run(thread.executor, lambda: None).wait(TIMEOUT_S)
        thread.executor.wake()
        thread.stop()
    assert "spin" not in [t.name for t in threading.enumerate()]
    assert not caplog.records


def test_the_callback_that_runs_is_waited_for(context):
    thread = ExecutorThread("spin", SingleThreadedExecutor(context=context))
    entered, go_on, ended = threading.Event(), threading.Event(), threading.Event()

    def work() -> None:
        entered.set()
        assert go_on.wait(TIMEOUT_S)
        ended.set()

    thread.start()
    thread.executor.create_task(work)
    assert entered.wait(TIMEOUT_S)
    threading.Timer(0.05, go_on.set).start()
    thread.stop()
    assert ended.is_set()


def test_one_that_never_started_stops_as_well_and_a_second_stop_does_nothing(context):
    thread = ExecutorThread("spin", SingleThreadedExecutor(context=context))
    thread.stop()
    thread.stop()
    assert "spin" not in [t.name for t in threading.enumerate()]


def test_it_ends_with_its_context(caplog):
    context = Context()
    rclpy.init(context=context, signal_handler_options=SignalHandlerOptions.NO)
    thread = ExecutorThread("spin", SingleThreadedExecutor(context=context))
    thread.start()
    context.try_shutdown()
    thread.stop()
    assert not caplog.records
