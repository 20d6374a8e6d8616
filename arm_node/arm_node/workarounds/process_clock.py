"""Gives the nodes of the process that makes simulation time that time, without /clock.

Works around https://github.com/ros2/rclpy/issues/1378: an rclpy node that only listens to /clock
takes a tenth of a core or more, and the process that publishes the time would listen to itself once
for each of its nodes. Made for rclpy 7.1; if it is switched off, the nodes use /clock.
"""

from collections.abc import Callable, Sequence
from typing import Any

from rcl_interfaces.msg import SetParametersResult
from rclpy.clock import ROSClock
from rclpy.clock_type import ClockType
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.time import Time

from arm_node.workarounds.stamp_clock import CLOCK_TOPIC
from arm_node.workarounds.switch import is_on

USE_SIM_TIME = "use_sim_time"


class ProcessClock(ROSClock):
    """The clock of all nodes of a process that makes simulation time.

    Reading it costs the loop nothing. What rcl itself does with a clock, such as timers and
    sleeping, needs the time in C: that is written from the first use on, once for all nodes.
    """

    def __new__(cls, now_ns: Callable[[], int]) -> "ProcessClock":
        """Make a clock of ROS's type, whose class rclpy chooses itself."""
        clock: Any = ROSClock.__new__(ROSClock)
        clock.__class__ = cls
        return clock

    def __init__(self, now_ns: Callable[[], int]) -> None:
        """Make a clock.

        Args:
            now_ns: returns the time in nanoseconds; any thread.
        """
        self._now_ns = now_ns
        self._used_in_c = False
        with super().handle:
            super().handle.set_ros_time_override_is_enabled(True)

    @property
    def handle(self) -> Any:
        """The clock in C, which is asked for only where C reads the time."""
        if not self._used_in_c:
            self._used_in_c = True
            self.advance()
        return super().handle

    @property
    def ros_time_is_active(self) -> bool:
        """True: the time is that of the simulation."""
        return True

    def now(self) -> Time:
        """Return the time of the simulation; any thread."""
        return Time(nanoseconds=self._now_ns(), clock_type=ClockType.ROS_TIME)

    def advance(self) -> None:
        """Wake what waits for the time; called after each change of it, on the loop thread."""
        if self._used_in_c:
            self.set_ros_time_override(self.now())

    def give(self, node: Node) -> None:
        """Make this the clock of a node that uses simulation time."""
        if not is_on("process_clock"):
            return
        for subscription in list(node.subscriptions):
            if subscription.topic_name == CLOCK_TOPIC:
                node.destroy_subscription(subscription)
        node._clock = self  # pyright: ignore[reportPrivateUsage]
        node.add_on_set_parameters_callback(_stay)


def _stay(changed: Sequence[Parameter]) -> SetParametersResult:
    """Refuse another clock: the node is part of the simulation."""
    stays = all(item.value is True for item in changed if item.name == USE_SIM_TIME)
    reason = "" if stays else f"{USE_SIM_TIME} stays true in the process of the simulation"
    return SetParametersResult(successful=stays, reason=reason)
