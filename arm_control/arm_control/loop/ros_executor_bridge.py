"""Passes the control loop's results to an rclpy executor; neither waits for the other.

Completing a future on another thread does not wake an executor whose coroutine awaits it, so the
functions here wake the executor as well.
"""

import threading
from collections.abc import Callable
from concurrent.futures import Future as LoopFuture
from typing import Any, TypeVar, cast

from rclpy.executors import Executor
from rclpy.task import Future

from arm_control.loop.control_loop import ControlLoop

ResultT = TypeVar("ResultT")

EXECUTOR_TIMEOUT_S = 5.0

PASSES_TO_ANSWER = 3
"""In the first pass the executor takes the pending requests and ends goals; in the next ones it
makes their results and sends them."""


def complete_future(future: Future, result: object, executor: Executor) -> None:
    """Complete a future that a coroutine of `executor` awaits; any thread."""
    future.set_result(result)
    executor.wake()


async def call_on_loop(
    loop: ControlLoop, function: Callable[[], ResultT], executor: Executor
) -> ResultT:
    """Run a function on the loop thread between two ticks; for coroutines of `executor`.

    Returns:
        Its result or exception; `LoopStoppedError` if the loop has ended.
    """
    return await wait_for_future(loop.call(function), executor)


async def wait_for_future(pending: "LoopFuture[ResultT]", executor: Executor) -> ResultT:
    """Wait for a future that another thread completes; for coroutines of `executor`.

    Returns:
        Its result or exception.
    """
    future = Future()

    def pass_on(done: "LoopFuture[Any]") -> None:
        error = done.exception()
        if error is None:
            complete_future(future, done.result(), executor)
            return
        future.set_exception(error)
        executor.wake()

    pending.add_done_callback(pass_on)
    return cast(ResultT, await future)


def run_on_executor(executor: Executor, function: Callable[[], None]) -> bool:
    """Run a function on the executor's thread and wait for it; call it from another thread.

    For actions that must not happen while the executor collects the entities to wait for, such as
    destroying an action server. If the executor does not spin, the function runs here.

    Returns:
        Whether the executor spins.
    """
    if not executor.get_nodes():
        # An executor that was shut down has no nodes and accepts no tasks.
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
    """Wait until the executor has answered all pending requests; call it from another thread.

    rclpy sends an action's result in a separate task, and the executor runs the latest task first:
    destroying the action server in the next task would lose the result.
    """
    for _ in range(PASSES_TO_ANSWER):
        if not run_on_executor(executor, lambda: None):
            return
