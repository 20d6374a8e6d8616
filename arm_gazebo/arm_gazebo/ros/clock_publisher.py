"""Publishes simulation time on /clock."""

from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rosgraph_msgs.msg import Clock

from arm_node.message_template import MessageTemplate

CLOCK_QOS = QoSProfile(depth=1, reliability=ReliabilityPolicy.RELIABLE)
"""Reliable, so that best-effort subscribers match as well as default ones."""


class RosClockPublisher:
    """Writes the time into one serialised message and publishes that. Loop thread."""

    def __init__(self, node: Node) -> None:
        self._publisher = node.create_publisher(Clock, "/clock", CLOCK_QOS)
        self._message = MessageTemplate(Clock())

    def publish(self, time_s: float) -> None:
        """Publish a simulation time."""
        self._message.set_stamps(round(time_s * 1e9))
        self._message.publish(self._publisher)
