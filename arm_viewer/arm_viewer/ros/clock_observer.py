"""How /clock goes beside the clock on the wall."""

import time

from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rclpy.serialization import deserialize_message
from rosgraph_msgs.msg import Clock

from arm_node.polled_subscriptions import PolledSubscriptions
from arm_viewer.clock_comparison import ClockComparison
from arm_viewer.ros.observer import TopicTypes
from arm_viewer.snapshot import SimulationTime

TOPIC = "/clock"
STANDS_STILL_S = 0.5
"""After so long without a message the simulation's time is taken to stand still."""
_QOS = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)


class ClockObserver:
    """Keeps how the simulation's time goes, while somebody publishes it."""

    def __init__(self, node: Node, polled: PolledSubscriptions) -> None:
        """Subscribe."""
        self._node = node
        self._polled = polled
        self._subscription = polled.subscribe(Clock, TOPIC, _QOS)
        self._comparison = ClockComparison()
        self._arrived_s = 0.0
        self.time: SimulationTime | None = None

    def discover(self, topics: TopicTypes) -> None:
        """Forget the clock that nobody publishes any more."""
        if not self._node.count_publishers(TOPIC):
            self._comparison.clear()
            self.time = None

    def collect(self, now_s: float) -> None:
        """Take what has arrived."""
        for data, information in self._polled.take(self._subscription, 1):
            clock = deserialize_message(data, Clock).clock  # pyright: ignore[reportAttributeAccessIssue]
            # Up to a collection's period ago, which would show in the factor.
            self._arrived_s = now_s - 1e-9 * (time.time_ns() - information["received_timestamp"])
            self._comparison.add(self._arrived_s, clock.sec + 1e-9 * clock.nanosec)
            self.time = self._comparison.result()
        if self.time is not None and now_s - self._arrived_s > STANDS_STILL_S:
            self._comparison.add(now_s, self.time.time_s)
            self.time = self._comparison.result()
