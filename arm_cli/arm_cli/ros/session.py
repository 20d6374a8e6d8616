"""A node for the duration of one command.

Everything happens in the main thread, and all waiting spins. SIGINT and SIGTERM set a flag that is
checked between two spins, so a command never ends in the middle of a callback, and can clean up
(for example cancel a goal) while its node still works.
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

from arm_cli.errors import CommandUsageError, StoppedError, UnansweredError
from arm_cli.names import absolute_name
from arm_cli.output import complain
from arm_node.printable import first_line
from arm_node.workarounds.deadlocked_end import DestructionLimit
from arm_node.workarounds.discovery import first_node
from arm_node.workarounds.private_files import made_private

POLL_S = 0.02
KNOWN_TIMEOUT_S = 3.0
NOTICE_AFTER_S = 1.0
"""After this time of waiting, the user is told what the command waits for."""
ACKNOWLEDGE_TIMEOUT_S = 1.0
LAST_ANSWER_S = 0.5
"""The last answer of a server that has ended may still be on its way for so long."""


class CommandSession:
    """The node of this command, and methods that wait while it spins. Use it in the main thread."""

    def __init__(self, node: Node, executor: Executor) -> None:
        """Use a node that has been added to the executor."""
        self.node = node
        self.started_s = time.monotonic()
        self._executor = executor
        self._stopped_by: int | None = None

    def stop(self, number: int, _frame: FrameType | None = None) -> None:
        """Make the waiting method raise a StoppedError; a signal handler."""
        self._stopped_by = number

    def clear_stop(self) -> None:
        """Forget a signal, to clean up with a working node."""
        self._stopped_by = None

    def clock_ns(self) -> int:
        """Return the time of the node's clock in ns."""
        return self.node.get_clock().now().nanoseconds

    def clock_s(self) -> float:
        """Return the time of the node's clock in s."""
        return self.clock_ns() * 1e-9

    def full_name(self, name: str) -> str:
        """Return the name of a topic, service or action as the graph shows it.

        Raises:
            NameValidationException: the name is not valid; `open_session` reports that.
        """
        full_name = absolute_name(name)
        validate_full_topic_name(full_name)
        return full_name

    def spin_once(self, timeout_s: float = POLL_S) -> None:
        """Run one callback, waiting up to `timeout_s` for it.

        Raises:
            StoppedError: a signal arrived.
        """
        self._executor.spin_once(timeout_sec=timeout_s)
        if self._stopped_by is not None:
            raise StoppedError(self._stopped_by)

    def be_known_to_server(self, service: str) -> None:
        """Wait until the server of a service has discovered this node's end points.

        An answer that a server sends earlier is lost, and a request must not be sent twice. A
        server that does not answer the question is sent the request all the same.
        """
        from arm_node.testing import DiscoveryCheck

        check = DiscoveryCheck.with_server(self.node, service)
        try:
            self.wait_until(lambda: check.complete, timeout_s=KNOWN_TIMEOUT_S)
        finally:
            check.close()

    def wait_until(
        self,
        condition: Callable[[], bool],
        waiting_for: Callable[[], str] | None = None,
        timeout_s: float | None = None,
    ) -> bool:
        """Spin until the condition holds; return whether it held before the timeout.

        Args:
            condition: checked after every callback and every 20 ms.
            waiting_for: returns a notice, printed on stderr after a second; None prints nothing.
            timeout_s: None waits forever.

        Raises:
            StoppedError: a signal arrived.
        """
        start = time.monotonic()
        if timeout_s is not None and timeout_s <= NOTICE_AFTER_S:
            waiting_for = None
        while not condition():
            waited = time.monotonic() - start
            # Before the end, so that a command that was held up says it as any other does.
            if waiting_for is not None and waited >= NOTICE_AFTER_S:
                complain(waiting_for())
                waiting_for = None
            if timeout_s is not None and waited >= timeout_s:
                return False
            self.spin_once()
        return True

    def spin_for(self, duration_s: float) -> None:
        """Spin for a duration.

        Raises:
            StoppedError: a signal arrived.
        """
        self.wait_until(lambda: False, timeout_s=duration_s)

    def wait_for_delivery(self, publishers: Iterable[Publisher], keep_alive_s: float) -> None:
        """Wait until the last messages of publishers are acknowledged, then for `keep_alive_s`.

        A message that a reader has not taken when its publisher ends is lost even if it was
        acknowledged, hence the additional time. A reader that does not acknowledge delays this by
        one second.

        Raises:
            StoppedError: a signal arrived.
        """
        deadline_s = time.monotonic() + ACKNOWLEDGE_TIMEOUT_S
        for publisher in publishers:
            left_s = deadline_s - time.monotonic()
            if left_s > 0 and publisher.get_subscription_count():
                publisher.wait_for_all_acked(Duration(seconds=left_s))
        self.spin_for(keep_alive_s)

    def result(
        self,
        future: Future,
        timeout_s: float | None = None,
        waiting_for: Callable[[], str] | None = None,
    ) -> Any:
        """Return a future's result, or None if it has none before the timeout; see `wait_until`.

        Raises:
            StoppedError: a signal arrived.
        """
        self.wait_until(future.done, waiting_for, timeout_s)
        return future.result() if future.done() else None

    def answer(
        self,
        future: Future,
        server: str,
        is_there: Callable[[], bool],
        timeout_s: float | None = None,
        waiting_for: Callable[[], str] | None = None,
    ) -> Any:
        """Return the answer of a server, or None if there is none before the timeout.

        `is_there` returns whether the service or action, which messages call `server`, has a
        server. See `wait_until` for the rest.

        Raises:
            UnansweredError: the server has ended.
            StoppedError: a signal arrived.
        """
        self.wait_until(lambda: future.done() or not is_there(), waiting_for, timeout_s)
        if not future.done() and not is_there():
            self.wait_until(future.done, timeout_s=LAST_ANSWER_S)
            if not future.done():
                raise UnansweredError(f"no answer from {server}: its server has ended")
        return future.result() if future.done() else None


@contextmanager
def open_session(name: str | None = None, use_sim_time: bool = False) -> Iterator[CommandSession]:
    """Yield a session with a light node; by default its name is unique and hidden from lists.

    Raises:
        CommandUsageError: ROS cannot start, for example because its log folder is not writable, or
            a given name is not valid.
    """
    try:
        with made_private():  # The log file.
            rclpy.init(args=[], signal_handler_options=SignalHandlerOptions.NO)
    except RuntimeError as error:
        raise CommandUsageError(f"cannot start ROS: {first_line(error)}") from error
    try:
        node = _first_node(name or f"_arm_cli_{os.getpid()}", use_sim_time)
        try:
            with SingleThreadedExecutor() as executor:
                executor.add_node(node)
                session = CommandSession(node, executor)
                with _signals_handled(session):
                    yield session
        finally:
            error = sys.exc_info()[1]
            limit = DestructionLimit()
            limit.start(0 if error is None else getattr(error, "exit_code", 1))
            node.destroy_node()
            limit.cancel()
    except NameValidationException as error:
        reason, quoted_name, *_ = str(error).splitlines()
        raise CommandUsageError(f"{quoted_name.strip()}: {reason.rstrip(':')}") from error
    finally:
        try_shutdown()


def _first_node(name: str, use_sim_time: bool) -> Node:
    try:
        return first_node(lambda: _make_node(name, use_sim_time))
    except RuntimeError as error:
        # For example a host in ROS_STATIC_PEERS that does not exist.
        raise CommandUsageError(f"cannot start ROS: {first_line(error)}") from error


def _make_node(name: str, use_sim_time: bool) -> Node:
    settings = {"start_type_description_service": False, "use_sim_time": use_sim_time}
    return Node(
        name,
        start_parameter_services=False,
        enable_rosout=False,
        parameter_overrides=[Parameter(key, value=value) for key, value in settings.items()],
    )


@contextmanager
def _signals_handled(session: CommandSession) -> Iterator[None]:
    numbers = (signal.SIGINT, signal.SIGTERM)
    previous = {number: signal.signal(number, session.stop) for number in numbers}
    try:
        yield
    finally:
        for number, handler in previous.items():
            signal.signal(number, handler)
