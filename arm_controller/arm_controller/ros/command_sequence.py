"""A node that publishes commands one after the other, at a constant rate."""

import time
from collections.abc import Iterator
from typing import Any

from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.node import Node

from arm_controller.ros.command_publisher import MatchedPublisher
from arm_controller.ros.parameters import declare_match_timeout_s
from arm_controller.subscriber_watch import Subscribers
from arm_node.process import EXIT_FAILED, EXIT_OK, NodeProcess

POLL_S = 0.05


class CommandSequence(Node):
    """Waits for the controller, then publishes commands until there are no more.

    Args:
        process: ends after the last command; with exit code 1 if there is no subscriber.
        name: name of the node.
        topic: topic of the commands.
        message_type: class of the messages.
        commands: the messages; endless for a node that runs until it is stopped.
        pace_s: time from one message to the next, and from the last one to the end.

    Raises:
        ParameterValueError: a given parameter is invalid.
    """

    def __init__(
        self,
        process: NodeProcess,
        name: str,
        topic: str,
        message_type: type[Any],
        commands: Iterator[Any],
        pace_s: float,
    ) -> None:
        super().__init__(name)
        self._match_timeout_s = declare_match_timeout_s(self)
        self._topic = MatchedPublisher(self, message_type, topic)
        self._commands = commands
        self._pace_s = pace_s
        self._process = process
        self._next_s: float | None = None
        # The timer uses the steady clock, so that it also runs while a simulation is paused.
        self._steady = Clock(clock_type=ClockType.STEADY_TIME)
        self._timer = self.create_timer(POLL_S, self._go_on, clock=self._steady)

    def _go_on(self) -> None:
        if self._next_s is None:
            self._look_for_listener()
        elif time.monotonic() >= self._next_s:
            self._publish(self._next_s)

    def _look_for_listener(self) -> None:
        self._topic.observe()
        waited_s = self._topic.unchanged_s
        if self._topic.is_ready:
            self._next_s = time.monotonic()
            self.get_logger().info(f"publishing on {self._topic.name}")
        elif self._topic.subscribers is Subscribers.NONE and waited_s >= self._match_timeout_s:
            self.get_logger().error(
                f"{self._topic.describe_subscribers()}: is the controller active?"
            )
            self._end(EXIT_FAILED)

    def _publish(self, due_s: float) -> None:
        command = next(self._commands, None)
        if command is None:
            self._end(EXIT_OK)
            return
        self._topic.publish(command)
        self._next_s = due_s + self._pace_s

    def _end(self, exit_code: int) -> None:
        self._timer.cancel()
        self._process.stop(exit_code)
