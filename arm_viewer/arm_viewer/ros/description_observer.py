"""Observe robot descriptions on all topics called robot_description, in any namespace."""

import math
from types import MappingProxyType

from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import String

from arm_description.errors import DescriptionError
from arm_description.resources import ResourceFinder
from arm_description.urdf.description import RobotDescription
from arm_description.urdf.parser import parse_urdf
from arm_node.polled_subscriptions import PolledSubscriptions
from arm_viewer.ros.observer import TopicTypes
from arm_viewer.ros.topic_reader import TopicGroup
from arm_viewer.snapshot import Description

WORD = "robot_description"
_LATCHED_QOS = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class DescriptionObserver:
    """Keeps the latest description of every published topic.

    Attributes:
        descriptions: descriptions by topic.
        lost: topics that no longer have a description.
    """

    def __init__(self, node: Node, polled: PolledSubscriptions) -> None:
        """Subscribe in the root namespace."""
        self._topics = TopicGroup(node, polled, String, WORD, _LATCHED_QOS)
        self._received_s: dict[str, float] = {}
        self.descriptions: MappingProxyType[str, Description] = MappingProxyType({})
        self.lost: frozenset[str] = frozenset()

    def discover(self, topics: TopicTypes) -> None:
        """Subscribe to new topics."""
        self._topics.discover(topics)

    def collect(self, now_s: float) -> None:
        """Take what has arrived, and forget what is outdated."""
        for reader in self._topics.readers():
            topic, message = reader.topic, reader.take_newest()
            if message is not None:
                self._received_s[topic] = now_s
                self._keep({**self.descriptions, topic: _read(topic, message.data)})
            elif self._received_s.get(topic, math.inf) < reader.outdated_before(now_s):
                del self._received_s[topic]
                self._keep({t: d for t, d in self.descriptions.items() if t != topic})

    def _keep(self, descriptions: dict[str, Description]) -> None:
        self.lost = (self.lost | self.descriptions.keys()) - descriptions.keys()
        self.descriptions = MappingProxyType(descriptions)


def _read(topic: str, text: str) -> Description:
    namespace = topic.removesuffix(f"/{WORD}")
    try:
        # The text may name the folders of its meshes, so each robot needs its own finder.
        description = RobotDescription(text)
        robot = ResourceFinder.of_description(text).located(parse_urdf(description))
        return Description(topic, namespace, robot, initial=description.initial_values())
    except DescriptionError as error:
        return Description(topic, namespace, None, f"{topic} is not a valid robot: {error}")
