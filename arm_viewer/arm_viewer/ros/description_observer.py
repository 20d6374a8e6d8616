"""The robots that are described on any topic whose last word is robot_description."""

from types import MappingProxyType

from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import String

from arm_description.errors import DescriptionError
from arm_description.urdf import parse_urdf
from arm_node.polled_subscriptions import PolledSubscriptions
from arm_viewer.ros.observer import TopicTypes
from arm_viewer.ros.topic_family import TopicFamily
from arm_viewer.snapshot import Description

WORD = "robot_description"
_LATCHED_QOS = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class DescriptionObserver:
    """Keeps the newest description of every such topic; one that nobody publishes stays."""

    def __init__(self, node: Node, polled: PolledSubscriptions) -> None:
        """Start to look."""
        self._topics = TopicFamily(node, polled, String, WORD, _LATCHED_QOS)
        self.descriptions: MappingProxyType[str, Description] = MappingProxyType({})

    def discover(self, topics: TopicTypes) -> None:
        """Subscribe to new topics."""
        self._topics.discover(topics)

    def collect(self, now_s: float) -> None:
        """Take what has arrived."""
        for reader in self._topics.readers():
            message = reader.take_newest()
            if message is not None:
                description = _read(reader.topic, message.data)
                self.descriptions = MappingProxyType(
                    {**self.descriptions, reader.topic: description}
                )


def _read(topic: str, text: str) -> Description:
    namespace = topic.removesuffix(f"/{WORD}")
    try:
        return Description(topic, namespace, parse_urdf(text))
    except DescriptionError as error:
        return Description(topic, namespace, None, f"{topic} describes no robot: {error}")
