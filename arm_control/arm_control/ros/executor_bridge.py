"""Brings the control loop's results to an rclpy executor, with neither waiting for the other.

An executor asleep is not woken where a future that one of its coroutines awaits is completed on
another thread, so whoever completes it wakes the executor, too.
"""

import threading
from collections.abc import Callable
from concurrent.futures import Future as LoopFuture
from typing import Any, TypeVar, cast

from rclpy.executors import Executor
from rclpy.task import Future

from arm_control.control_loop import ControlLoop

ResultT = TypeVar("ResultT")

EXECUTOR_TIMEOUT_S = 5.0

PASSES_TO_ANSWER = 2
"""In the first the executor takes the requests that have come, in the second it runs the tasks
which answer them."""


def settle(future: Future, result: object, executor: Executor) -> None:
    """Complete a future that a coroutine of `executor` awaits; any thread."""
    future.set_result(result)
    executor.wake()


async def call_on_loop(
    loop: ControlLoop, function: Callable[[], ResultT], executor: Executor
) -> ResultT:
    """Run a function on the loop thread between two ticks; for coroutines of `executor`.

    Returns:
        Its result, or what it raised; `LoopStoppedError` where the loop runs no more.
    """
    return await completed(loop.call(function), executor)


async def completed(promised: "LoopFuture[ResultT]", executor: Executor) -> ResultT:
    """Wait for what another thread has promised; for coroutines of `executor`.

    Returns:
        The result, or what was raised instead.
    """
    future = Future()

    def pass_on(done: "LoopFuture[Any]") -> None:
        error = done.exception()
        if error is None:
            settle(future, done.result(), executor)
            return
        future.set_exception(error)
        executor.wake()

    promised.add_done_callback(pass_on)
    return cast(ResultT, await future)


def run_on_executor(executor: Executor, function: Callable[[], None]) -> bool:
    """Run a function where the executor runs callbacks, and wait for it; not on that thread.

    For what must not happen while the executor gathers the entities to wait for, such as the end
    of an action server. Where the executor does not spin the function runs here.

    Returns:
        Whether the executor spins.
    """
    if not executor.get_nodes():
        # One that was shut down has let go of its nodes, and takes no tasks any more.
        function()
        return False
    done = threading.Event()

    def run() -> None:
        try:
            function()
        finally:
            done.set()

    task = executor.create_task(run)
    if done.wait(EXECUTOR_TIMEOUT_S):
        return True
    task.cancel()
    function()
    return False


def let_executor_answer(executor: Executor) -> None:
    """Wait until the executor has answered what has come to it by now; not on its thread.

    rclpy sends an action's result in a task of its own, and the executor runs the latest task
    first: an action server that is destroyed in the next one takes the result with it.
    """
    for _ in range(PASSES_TO_ANSWER):
        if not run_on_executor(executor, lambda: None):
            return
