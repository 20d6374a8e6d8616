"""Tells whether simulation time stands still, paused or in lock-step."""

from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rclpy.serialization import deserialize_message
from rosgraph_msgs.msg import Clock

from arm_node.polled_subscriptions import PolledSubscriptions
from arm_node.workarounds.clocks import CLOCK_TOPIC, USE_SIM_TIME
from arm_planning.ros.convert import seconds

SILENCE_S = 0.25
"""A clock of which nothing is heard for this long stands still."""
NEWEST = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)


class HeldTime:
    """Compares simulation time with stamps. One thread at a time.

    A simulation publishes /clock in each control period, which costs it and its subscribers
    something, and not at all while time stands still. So the topic is subscribed to on the first
    question, and then for good: where time was held once, it will be again.
    """

    def __init__(self, node: Node, polled: PolledSubscriptions) -> None:
        """Do nothing yet.

        Args:
            node: whose parameter `use_sim_time` counts.
            polled: makes the subscription.
        """
        self._node = node
        self._polled = polled
        self._subscription = None
        self._time_s: float | None = None
        self._silent_since_s: float | None = None

    @property
    def is_heard(self) -> bool:
        """Whether the clock is known, so that a question costs nothing more."""
        return self._time_s is not None

    def is_at(self, stamp_s: float, within_s: float, now_s: float) -> bool:
        """Whether it is still about the time of a stamp; False where there is no simulation time.

        After a first silence it is at any stamp: time that stood still before the subscription was
        there is not known, and what was published last is the present.

        Args:
            stamp_s: the stamp.
            within_s: how far simulation time may be from it.
            now_s: wall time that never goes back.
        """
        if not self._node.get_parameter(USE_SIM_TIME).value:
            return False
        if self._subscription is None:
            self._subscription = self._polled.subscribe(Clock, CLOCK_TOPIC, NEWEST)
        if not self._subscription.get_publisher_count():
            self._time_s = self._silent_since_s = None
            return False
        for raw, _ in self._polled.take(self._subscription, 1):
            self._time_s = seconds(deserialize_message(raw, Clock).clock)
        if self._time_s is not None:
            return abs(self._time_s - stamp_s) < within_s
        if self._silent_since_s is None:
            self._silent_since_s = now_s
        return now_s - self._silent_since_s >= SILENCE_S
