"""A node for the duration of one command.

Everything happens in the main thread: what waits, spins. SIGINT and SIGTERM set a flag that is
looked at between two spins, so a command never ends in the middle of a callback and can tidy up
(a goal is cancelled) while its node still works.
"""

import os
import signal
import sys
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any

import rclpy
from rclpy.duration import Duration
from rclpy.exceptions import NameValidationException
from rclpy.executors import Executor, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.publisher import Publisher
from rclpy.signals import SignalHandlerOptions
from rclpy.task import Future
from rclpy.utilities import try_shutdown
from rclpy.validate_full_topic_name import validate_full_topic_name

from arm_cli.errors import StoppedError, UsageError
from arm_cli.names import absolute_name
from arm_node.discovery import answers_held_back
from arm_node.process import first_line

POLL_S = 0.02
PATIENCE_S = 1.0
"""Whoever waits longer than this is told what for."""
ACKNOWLEDGED_WITHIN_S = 1.0


class Session:
    """The node of this command, and the ways to wait with it. Use it in the main thread."""

    def __init__(self, node: Node, executor: Executor) -> None:
        """Take over a node that the executor has."""
        self.node = node
        self.started_s = time.monotonic()
        self._executor = executor
        self._stopped_by: int | None = None

    def stop(self, number: int, _frame: FrameType | None = None) -> None:
        """Let whatever waits raise a StoppedError; a signal handler."""
        self._stopped_by = number

    def go_on(self) -> None:
        """Forget a signal, to tidy up with a working node."""
        self._stopped_by = None

    def clock_ns(self) -> int:
        """Return the time of the node's clock in ns."""
        return self.node.get_clock().now().nanoseconds

    def clock_s(self) -> float:
        """Return the time of the node's clock in s."""
        return self.clock_ns() * 1e-9

    def full_name(self, name: str) -> str:
        """Return the name of a topic, service or action as the graph has it.

        Raises:
            NameValidationException: there can be no such name; `open_session` says so to the user.
        """
        full_name = absolute_name(name)
        validate_full_topic_name(full_name)
        return full_name

    def spin_once(self, timeout_s: float = POLL_S) -> None:
        """Serve one callback, or wait that long for one.

        Raises:
            StoppedError: a signal came.
        """
        self._executor.spin_once(timeout_sec=timeout_s)
        if self._stopped_by is not None:
            raise StoppedError(self._stopped_by)

    def wait_until(
        self,
        condition: Callable[[], bool],
        waiting_for: Callable[[], str] | None = None,
        timeout_s: float | None = None,
    ) -> bool:
        """Spin until the condition holds; return whether it does, within the time-out.

        Args:
            condition: asked after every callback and every 20 ms.
            waiting_for: says after a second, on stderr, what is waited for; None says nothing.
            timeout_s: None waits for ever.

        Raises:
            StoppedError: a signal came.
        """
        start = time.monotonic()
        while not condition():
            waited = time.monotonic() - start
            if timeout_s is not None and waited >= timeout_s:
                return False
            if waiting_for is not None and waited >= PATIENCE_S:
                print(waiting_for(), file=sys.stderr, flush=True)
                waiting_for = None
            self.spin_once()
        return True

    def spin_for(self, duration_s: float) -> None:
        """Spin for some seconds.

        Raises:
            StoppedError: a signal came.
        """
        self.wait_until(lambda: False, timeout_s=duration_s)

    def let_arrive(self, publishers: Iterable[Publisher], keep_alive_s: float) -> None:
        """Wait for the last messages of publishers to be acknowledged, and then some seconds.

        What a reader has not taken when its publisher ends is gone, acknowledged or not; hence
        the seconds after it. A reader that does not acknowledge holds this up for one second.

        Raises:
            StoppedError: a signal came.
        """
        deadline_s = time.monotonic() + ACKNOWLEDGED_WITHIN_S
        for publisher in publishers:
            left_s = deadline_s - time.monotonic()
            if left_s > 0 and publisher.get_subscription_count():
                publisher.wait_for_all_acked(Duration(seconds=left_s))
        self.spin_for(keep_alive_s)

    def result(self, future: Future, timeout_s: float | None = None) -> Any:
        """Return a future's result, None where it has none within the time-out.

        Raises:
            StoppedError: a signal came.
        """
        self.wait_until(future.done, timeout_s=timeout_s)
        return future.result() if future.done() else None


@contextmanager
def open_session(name: str | None = None, use_sim_time: bool = False) -> Iterator[Session]:
    """Give a node that is hidden from lists, and as light as can be.

    Args:
        name: of the node; by default hidden and unique.
        use_sim_time: whether the node's clock follows /clock.

    Raises:
        UsageError: ROS cannot start; its log folder may not be writable. Or nothing in ROS can have
            a name that was given.
    """
    try:
        rclpy.init(args=[], signal_handler_options=SignalHandlerOptions.NO)
    except RuntimeError as error:
        raise UsageError(f"cannot start ROS: {first_line(error)}") from error
    try:
        with answers_held_back():
            node = _make_node(name or f"_arm_cli_{os.getpid()}", use_sim_time)
        try:
            with SingleThreadedExecutor() as executor:
                executor.add_node(node)
                session = Session(node, executor)
                with _signals_handled(session):
                    yield session
        finally:
            node.destroy_node()
    except NameValidationException as error:
        reason, quoted_name, *_ = str(error).splitlines()
        raise UsageError(f"{quoted_name.strip()}: {reason.rstrip(':')}") from error
    finally:
        try_shutdown()


def _make_node(name: str, use_sim_time: bool) -> Node:
    settings = {"start_type_description_service": False, "use_sim_time": use_sim_time}
    return Node(
        name,
        start_parameter_services=False,
        enable_rosout=False,
        parameter_overrides=[Parameter(key, value=value) for key, value in settings.items()],
    )


@contextmanager
def _signals_handled(session: Session) -> Iterator[None]:
    numbers = (signal.SIGINT, signal.SIGTERM)
    previous = {number: signal.signal(number, session.stop) for number in numbers}
    try:
        yield
    finally:
        for number, handler in previous.items():
            signal.signal(number, handler)
