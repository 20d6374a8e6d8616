"""Results of the control loop that come to an executor asleep."""

import threading
from collections.abc import Iterator
from typing import Any

import pytest
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.task import Future

import arm_control.loop.ros_executor_bridge
from arm_control.errors import LoopStoppedError
from arm_control.loop.control_loop import ControlLoop
from arm_control.loop.pacer import Pacer

TIMEOUT_S = 60.0


@pytest.fixture
def loop() -> Iterator[ControlLoop]:
    """Return a paused loop."""
    loop = ControlLoop(lambda: None, Pacer(0.01))
    loop.start(paused=True)
    yield loop
    loop.stop()
    assert loop.join(TIMEOUT_S)


@pytest.fixture
def bridge():
    return arm_control.loop.ros_executor_bridge


def result_of(client: Any, coroutine: Any) -> Any:
    """Run a coroutine function on the client's executor; return what it returns."""
    done = threading.Event()
    task = client.executor.create_task(coroutine)
    task.add_done_callback(lambda _: done.set())
    assert done.wait(TIMEOUT_S)
    return task.result()


def test_the_loops_result_wakes_an_executor_asleep(client, loop, bridge):
    async def ask() -> str:
        return await bridge.call_on_loop(
            loop, lambda: threading.current_thread().name, client.executor
        )

    assert result_of(client, ask) == "control loop"


def test_a_future_completed_on_another_thread_wakes_an_executor_asleep(client, bridge):
    future = Future()
    awaited = threading.Event()

    async def wait() -> Any:
        awaited.set()
        return await future

    def complete() -> None:
        assert awaited.wait(TIMEOUT_S)
        bridge.complete_future(future, 42, client.executor)

    thread = threading.Thread(target=complete)
    thread.start()
    assert result_of(client, wait) == 42
    thread.join(TIMEOUT_S)


def test_what_the_function_raises_comes_out_of_the_await(client, loop, bridge):
    async def ask() -> str:
        try:
            await bridge.call_on_loop(loop, lambda: 1 // 0, client.executor)
        except ZeroDivisionError:
            return "raised"
        return "returned"

    assert result_of(client, ask) == "raised"


def test_a_loop_that_has_ended_says_so(client, bridge):
    ended = ControlLoop(lambda: None, Pacer(0.01))
    ended.start()
    ended.stop()
    assert ended.join(TIMEOUT_S)

    async def ask() -> str:
        try:
            await bridge.call_on_loop(ended, lambda: None, client.executor)
        except LoopStoppedError as error:
            return str(error)
        return ""

    assert result_of(client, ask) == "the control loop has ended"


def test_a_function_runs_on_the_executors_thread(client, bridge):
    threads: list[int] = []
    executors: list[int] = []
    bridge.run_on_executor(client.executor, lambda: threads.append(threading.get_ident()))
    bridge.run_on_executor(client.executor, lambda: executors.append(threading.get_ident()))
    assert threads == executors != [threading.get_ident()]


def test_what_the_executor_has_yet_to_answer_is_answered_first(client, bridge, monkeypatch):
    order: list[str] = []
    asked = threading.Event()
    followed = threading.Event()
    create_task = client.executor.create_task

    def create_following_task(function: Any) -> Any:
        task = create_task(function)
        followed.set()
        return task

    def take_request() -> None:
        create_task(lambda: order.append("answer"))
        asked.set()
        assert followed.wait(TIMEOUT_S)  # what is asked for meanwhile is the latest task

    create_task(take_request)
    monkeypatch.setattr(client.executor, "create_task", create_following_task)
    assert asked.wait(TIMEOUT_S)
    bridge.let_executor_answer(client.executor)
    bridge.run_on_executor(client.executor, lambda: order.append("end"))
    assert order == ["answer", "end"]


def test_a_function_runs_though_the_executor_does_not(bridge, client):
    idle = SingleThreadedExecutor(context=client.context)
    ran: list[int] = []
    bridge.run_on_executor(idle, lambda: ran.append(threading.get_ident()))
    assert ran == [threading.get_ident()]
    idle.shutdown()


def test_an_executor_that_was_shut_down_is_not_needed(bridge):
    context = Context()
    context.init()
    executor = SingleThreadedExecutor(context=context)
    executor.shutdown()
    threads: list[str] = []

    bridge.run_on_executor(executor, lambda: threads.append(threading.current_thread().name))

    context.try_shutdown()
    assert threads == [threading.current_thread().name]
