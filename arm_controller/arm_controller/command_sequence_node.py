"""The demos' example nodes: each publishes commands one after the other, at a constant rate."""

import time
from collections.abc import Iterable
from itertools import repeat
from typing import TYPE_CHECKING, Any

from geometry_msgs.msg import TwistStamped
from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.node import Node
from std_msgs.msg import Float64MultiArray

from arm_controller.ros_parameters import declare_match_timeout_s
from arm_controller.ros_position_commands import POLL_S, MatchedPublisher

if TYPE_CHECKING:
    from arm_node.process import NodeProcess

GRIPPER_COMMANDS = (0.0, 0.38, 0.19, 0.0)
"""In m or N, depending on the gripper's command interface."""
GRIPPER_PACE_S = 1.0
FORWARDS_M_S, TO_THE_LEFT_RAD_S = 0.1, 0.1
DRIVE_PACE_S = 0.05


class CommandSequence(Node):
    """Waits for the controller, then publishes commands until there are no more.

    Args:
        process: ends after the last command; with exit code 1 if there is no subscriber.
        name: name of the node.
        topic: topic of the commands.
        commands: the messages; endless for a node that runs until it is stopped.
        pace_s: time from one message to the next, and from the last one to the end.

    Raises:
        ParameterValueError: a given parameter is invalid.
    """

    def __init__(
        self,
        process: "NodeProcess",
        name: str,
        topic: tuple[str, type[Any]],
        commands: Iterable[Any],
        pace_s: float,
    ) -> None:
        super().__init__(name)
        self._process = process
        self._match_timeout_s = declare_match_timeout_s(self)
        self._topic = MatchedPublisher(self, topic[1], topic[0])
        self._commands = iter(commands)
        self._pace_s = pace_s
        self._next_s: float | None = None
        # The timer uses the steady clock, so that it also runs while a simulation is paused.
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        self._timer = self.create_timer(POLL_S, self._go_on, clock=steady)

    def _go_on(self) -> None:
        if self._next_s is None:
            self._look_for_listener()
        elif time.monotonic() >= self._next_s:
            self._publish(self._next_s)

    def _look_for_listener(self) -> None:
        self._topic.observe()
        if self._topic.is_ready:
            self._next_s = time.monotonic()
            self.get_logger().info(f"publishing on {self._topic.topic}")
        elif self._topic.silence_s >= self._match_timeout_s:
            listeners = self._topic.describe_subscribers()
            self.get_logger().error(f"{listeners}: is the controller active?")
            self._end(1)

    def _publish(self, due_s: float) -> None:
        command = next(self._commands, None)
        if command is None:
            self._end(0)
            return
        self._topic.publish(command)
        self._next_s = due_s + self._pace_s

    def _end(self, exit_code: int) -> None:
        self._timer.cancel()
        self._process.stop(exit_code)


def gripper_example(process: "NodeProcess") -> CommandSequence:
    """Return the node that closes the demo's gripper, opens it halfway, and releases it."""
    return CommandSequence(
        process,
        "gripper_test_node",
        ("gripper_controller/commands", Float64MultiArray),
        [Float64MultiArray(data=[command]) for command in GRIPPER_COMMANDS],
        GRIPPER_PACE_S,
    )


def diff_drive_example(process: "NodeProcess") -> CommandSequence:
    """Return the node that drives a two-wheeled robot in circles until it is stopped."""
    # Without a stamp the command counts as new, even if the controller uses simulation time.
    command = TwistStamped()
    command.twist.linear.x = FORWARDS_M_S
    command.twist.angular.z = TO_THE_LEFT_RAD_S
    return CommandSequence(
        process,
        "diff_drive_test_node",
        ("diff_drive_base_controller/cmd_vel", TwistStamped),
        repeat(command),
        DRIVE_PACE_S,
    )
