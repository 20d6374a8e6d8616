"""Simulation time from the stamps of what a node hears anyway, instead of from /clock."""

from rclpy.clock import ROSClock
from rclpy.clock_type import ClockType
from rclpy.node import Node
from rclpy.time import Time

CLOCK_TOPIC = "/clock"
SET_BACK_NS = 1_000_000_000
"""An older stamp is a message that was late; one older by more than this is a time set back."""


class StampClock:
    """Sets a node's clock by the stamps of its messages, where it goes by simulation time.

    A simulation publishes /clock in every control period. To a node that only answers messages
    of the same period their stamps tell the same, at half of what it and the simulation spend on
    its listening. A node that comes to use simulation time later on listens to /clock. Executor's
    thread.
    """

    def __init__(self, node: Node) -> None:
        """Let go of /clock if the node listens to it; otherwise there is nothing to do."""
        clock = node.get_clock()
        self._clock: ROSClock | None = None
        for subscription in list(node.subscriptions):
            if subscription.topic_name == CLOCK_TOPIC and isinstance(clock, ROSClock):
                node.destroy_subscription(subscription)
                self._clock = clock

    def hear(self, stamp_ns: int) -> None:
        """Take note of a message's stamp."""
        if self._clock is None:
            return
        ahead_ns = stamp_ns - self._clock.now().nanoseconds
        if ahead_ns > 0 or ahead_ns < -SET_BACK_NS:
            time = Time(nanoseconds=stamp_ns, clock_type=ClockType.ROS_TIME)
            self._clock.set_ros_time_override(time)
