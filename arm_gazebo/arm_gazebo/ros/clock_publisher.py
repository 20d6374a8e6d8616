"""Publishes simulation time on /clock."""

from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rosgraph_msgs.msg import Clock

from arm_control.outbox import Outbox
from arm_node.message_template import MessageTemplate
from arm_node.raw_publisher import RawPublisher

CLOCK_QOS = QoSProfile(depth=1, reliability=ReliabilityPolicy.RELIABLE)
"""Reliable, so that best-effort subscribers match as well as default ones."""


class RosClockPublisher:
    """Writes the time into one serialised message and publishes that. Loop thread.

    It is the clock of this process, too (see `arm_control.clock.Clock`): what it has published
    last is what everybody else takes for the time.
    """

    def __init__(self, node: Node, outbox: Outbox) -> None:
        """Offer the topic.

        Args:
            node: of the simulation.
            outbox: of the loop that publishes.
        """
        self._node = node
        self._outbox = outbox
        self._known_publishers = 1
        publisher = node.create_publisher(Clock, "/clock", CLOCK_QOS)
        self._topic = publisher.topic_name
        self._publisher = RawPublisher(publisher)
        self._message = MessageTemplate(Clock())
        self._time_s = 0.0

    def now_s(self) -> float:
        """Return the time published last; any thread."""
        return self._time_s

    def publish(self, time_s: float) -> None:
        """Publish a simulation time."""
        self._time_s = time_s
        if self._publisher.wanted():
            self._message.set_stamps(round(time_s * 1e9))
            self._outbox.put(self._publisher.publish, self._message.to_bytes())

    def take_warning(self) -> str | None:
        """Return that others publish the time as well, where there are more than the last time.

        Executor's thread.
        """
        topic = self._topic
        known, self._known_publishers = self._known_publishers, self._node.count_publishers(topic)
        if self._known_publishers <= max(known, 1):
            return None
        infos = self._node.get_publishers_info_by_topic(topic)
        nodes = ", ".join(f"{i.node_namespace.rstrip('/')}/{i.node_name}" for i in infos)
        return (
            f"{topic} has {self._known_publishers} publishers: {nodes}; time jumps to and fro. "
            "Does another simulation run? End it, or give one of them another ROS_DOMAIN_ID"
        )
