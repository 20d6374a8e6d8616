"""The executor of the nodes of controllers and hardware components."""

from collections.abc import Iterator
from contextlib import contextmanager
from inspect import iscoroutinefunction

from rclpy.executors import Executor
from rclpy.experimental.events_executor import EventsExecutor
from rclpy.node import Node

from arm_control.errors import ControllerError
from arm_node.executor_thread import ExecutorThread

LONGEST_WAIT_S = 1.0
"""Without a timeout, spin_once of the event-driven executor polls the clock and holds the GIL."""


@contextmanager
def controllers_executor() -> Iterator[Executor]:
    """Spin an event-driven executor in a thread until the end of `with`.

    For each message rclpy's usual executor looks at all nodes that it has. With the event-driven
    one, the simulation of an arm that is commanded at 100 Hz takes half of the processor time, and
    that of 4 arms a third; a command to one of 16 arms moves it after half of the time.
    """
    thread = ExecutorThread("controllers", EventsExecutor(), LONGEST_WAIT_S)
    thread.start()
    try:
        yield thread.executor
    finally:
        thread.stop()


def check_callbacks(node: Node) -> None:
    """Check that the executor can run the callbacks of a node.

    rclpy's event-driven executor would answer a request with the coroutine itself.

    Raises:
        ControllerError: a callback is a coroutine function.
    """
    named = [(f"service {service.srv_name}", service.callback) for service in node.services]
    named += [(f"topic {each.topic_name}", each.callback) for each in node.subscriptions]
    named += [("a timer", timer.callback) for timer in node.timers]
    for what, callback in named:
        if iscoroutinefunction(callback):
            raise ControllerError(
                f"the callback of {what} is a coroutine, which is never run; use a plain function"
            )
