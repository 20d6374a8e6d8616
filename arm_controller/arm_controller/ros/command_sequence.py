"""A node that publishes commands one after the other, at a steady pace."""

from collections.abc import Callable, Iterator
from typing import Any

from rclpy.node import Node

from arm_controller.listener_watch import Audience
from arm_controller.ros.clock_time import seconds, steady_clock
from arm_controller.ros.command_topic import CommandTopic
from arm_controller.ros.parameters import declare_match_timeout_s

POLL_S = 0.05


class CommandSequence(Node):
    """Waits for the controller that the commands are for, and publishes until there are no more.

    Args:
        name: of the node.
        topic: of the commands.
        message_type: class of the messages.
        commands: the messages; without end for a node that runs until it is stopped.
        pace_s: from one message to the next, and from the last one to the end.
        on_end: called in the executor's thread with whether the commands were published.

    Raises:
        ParameterValueError: a parameter that was given makes no sense.
    """

    def __init__(
        self,
        name: str,
        topic: str,
        message_type: type[Any],
        commands: Iterator[Any],
        pace_s: float,
        on_end: Callable[[bool], None],
    ) -> None:
        super().__init__(name)
        self._match_timeout_s = declare_match_timeout_s(self)
        self._topic = CommandTopic(self, message_type, topic)
        self._commands = commands
        self._pace_s = pace_s
        self._on_end = on_end
        self._next_s: float | None = None
        # A simulation that stands still must be noticed, so its clock does not drive the timer.
        self._steady = steady_clock()
        self._timer = self.create_timer(POLL_S, self._go_on, clock=self._steady)

    def _go_on(self) -> None:
        if self._next_s is None:
            self._look_for_listener()
        elif seconds(self._steady) >= self._next_s:
            self._publish(self._next_s)

    def _look_for_listener(self) -> None:
        self._topic.observe()
        waited_s = self._topic.lasting_s
        if self._topic.is_ready:
            self._next_s = seconds(self._steady)
            self.get_logger().info(f"publishing on {self._topic.name}")
        elif self._topic.audience is Audience.NOBODY and waited_s >= self._match_timeout_s:
            self.get_logger().error(f"{self._topic.describe_audience()}: is the controller active?")
            self._end(False)

    def _publish(self, due_s: float) -> None:
        command = next(self._commands, None)
        if command is None:
            self._end(True)
            return
        self._topic.publish(command)
        self._next_s = due_s + self._pace_s

    def _end(self, published: bool) -> None:
        self._timer.cancel()
        self._on_end(published)
