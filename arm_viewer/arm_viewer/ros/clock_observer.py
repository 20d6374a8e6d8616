"""Observe /clock and compare it with wall time."""

import time
from dataclasses import replace

from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rclpy.serialization import deserialize_message
from rosgraph_msgs.msg import Clock

from arm_node.polled_subscriptions import PolledSubscriptions
from arm_viewer.clock_comparison import ClockComparison
from arm_viewer.ros.observer import TopicTypes
from arm_viewer.snapshot import SimulationTime

TOPIC = "/clock"
PAUSED_AFTER_S = 0.5
"""After this time without a message the simulation counts as paused."""
_QOS = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)


class ClockObserver:
    """Keeps the progress of simulation time while /clock is published."""

    def __init__(self, node: Node, polled: PolledSubscriptions) -> None:
        """Subscribe."""
        self._node = node
        self._polled = polled
        self._subscription = polled.subscribe(Clock, TOPIC, _QOS)
        self._comparison = ClockComparison()
        self._arrived_s = 0.0
        self.time: SimulationTime | None = None

    def discover(self, topics: TopicTypes) -> None:
        """Forget a clock that is no longer published."""
        if not self._node.count_publishers(TOPIC):
            self._comparison.clear()
            self.time = None

    def collect(self, now_s: float) -> None:
        """Take what has arrived."""
        for data, information in self._polled.take(self._subscription, 1):
            clock = deserialize_message(data, Clock).clock  # pyright: ignore[reportAttributeAccessIssue]
            # It arrived up to one collection period ago, which would be visible in the factor.
            before_s = self._arrived_s
            self._arrived_s = now_s - 1e-9 * (time.time_ns() - information["received_timestamp"])
            if self._arrived_s - before_s > PAUSED_AFTER_S:
                self._comparison.clear()  # A pause is not lag.
            self._comparison.add(self._arrived_s, clock.sec + 1e-9 * clock.nanosec)
            self.time = self._comparison.result()
        if self.time is not None and now_s - self._arrived_s > PAUSED_AFTER_S:
            self.time = replace(self.time, factor=0.0)
