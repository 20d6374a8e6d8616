"""Observe joint positions in controller managers' introspection data, without joint states.

A simulation or robot without a joint_state_broadcaster publishes them nowhere else.
"""

import math
from collections.abc import Mapping
from typing import Any

from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy

from arm_node.polled_subscriptions import PolledSubscriptions
from arm_viewer.ros.observer import TopicTypes, topics_of
from arm_viewer.ros.topic_reader import TopicReader

SUFFIX = "/introspection_data/full"
KIND, INTERFACE = "state_interface.", "/position"
_QOS = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)


class HardwareObserver:
    """Keeps the hardware's joint positions where nobody publishes joint states.

    Attributes:
        positions: positions in rad or m, by namespace and joint.
    """

    def __init__(self, node: Node, polled: PolledSubscriptions) -> None:
        """Start without subscriptions: managers publish this data only to subscribers."""
        self._node = node
        self._polled = polled
        self._message_class = _message_class()
        self._readers: dict[str, TopicReader[Any]] = {}
        self.positions: Mapping[str, Mapping[str, float]] = {}

    def discover(self, topics: TopicTypes) -> None:
        """Subscribe in namespaces without joint states, and unsubscribe in the others."""
        if self._message_class is None:
            return
        wanted = {
            topic
            for topic in topics_of(self._message_class, topics, self._node)
            if topic.endswith(SUFFIX)
            and self._node.count_publishers(topic)
            and not self._node.count_publishers(f"{_namespace(topic)}/joint_states")
        }
        for topic in self._readers.keys() - wanted:
            self._readers.pop(topic).close()
            self.positions = {n: p for n, p in self.positions.items() if n != _namespace(topic)}
        for topic in wanted - self._readers.keys():
            self._readers[topic] = TopicReader(
                self._node, self._polled, self._message_class, topic, _QOS
            )

    def collect(self, now_s: float) -> None:
        """Take what has arrived."""
        for topic, reader in self._readers.items():
            message = reader.take_newest()
            if message is not None:
                self.positions = {**self.positions, _namespace(topic): _read(message)}


def _message_class() -> Any:
    try:
        from pal_statistics_msgs.msg import Statistics
    except ImportError:
        # A ROS installation may lack the package; its managers then publish no such data.
        return None
    return Statistics


def _namespace(topic: str) -> str:
    """Return the namespace of the manager: "/left", or "" for the root namespace."""
    return topic.removesuffix(SUFFIX).rpartition("/")[0]


def _read(message: Any) -> dict[str, float]:
    return {
        entry.name.removeprefix(KIND).removesuffix(INTERFACE): entry.value
        for entry in message.statistics
        if entry.name.startswith(KIND)
        and entry.name.endswith(INTERFACE)
        and math.isfinite(entry.value)
    }
