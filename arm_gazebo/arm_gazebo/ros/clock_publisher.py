"""Publish simulation time on /clock."""

from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rosgraph_msgs.msg import Clock

from arm_control.loop.outbox import Outbox
from arm_node.workarounds.clocks import ProcessClock
from arm_node.workarounds.message_template import MessageTemplate, raw_sender

CLOCK_QOS = QoSProfile(depth=1, reliability=ReliabilityPolicy.RELIABLE)
"""Reliable, so that both default and best-effort subscribers match."""


class RosClockPublisher:
    """Writes the time into one serialised message and publishes it. Loop thread.

    It is also the clock of this process (see `arm_control.loop.clock.Clock`), because the time that
    it published last is the time that every other node uses.

    Attributes:
        of_nodes: the same clock for the nodes of this process.
    """

    def __init__(self, node: Node, outbox: Outbox) -> None:
        """Create the publisher; the outbox is that of the loop that publishes."""
        self._node = node
        self._outbox = outbox
        self._known_publishers = 1
        self._publisher = node.create_publisher(Clock, "/clock", CLOCK_QOS)
        self._send = raw_sender(self._publisher)
        self._topic = self._publisher.topic_name
        self._message = MessageTemplate(Clock())
        self._time_s = 0.0
        self.of_nodes = ProcessClock(lambda: round(self._time_s * 1e9))

    def now_s(self) -> float:
        """Return the last published time; any thread."""
        return self._time_s

    def publish(self, time_s: float) -> None:
        """Publish a simulation time."""
        self._time_s = time_s
        self.of_nodes.advance()
        if self._publisher.get_subscription_count():
            self._message.set_stamps(round(time_s * 1e9))
            self._outbox.put(self._send, self._message.to_bytes())

    def take_warning(self) -> str | None:
        """Return a warning if the topic has gained other publishers; executor thread."""
        topic = self._topic
        known, self._known_publishers = self._known_publishers, self._node.count_publishers(topic)
        if self._known_publishers <= max(known, 1):
            return None
        infos = self._node.get_publishers_info_by_topic(topic)
        nodes = ", ".join(f"{i.node_namespace.rstrip('/')}/{i.node_name}" for i in infos)
        return (
            f"{topic} has {self._known_publishers} publishers: {nodes}; time jumps back and forth. "
            "Is another simulation running? End it, or give one of them another ROS_DOMAIN_ID"
        )
