"""Observe joint states on all topics called joint_states, in any namespace.

A simulation or robot without a joint_state_broadcaster publishes its joints' positions only
in its controller manager's introspection data.
"""

import math
from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import Any

from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import JointState

from arm_node.polled_subscriptions import PolledSubscriptions
from arm_node.qos import NEWEST
from arm_viewer.ros.observer import Observer, TopicTypes, keep_in_step, topics_of
from arm_viewer.ros.topic_reader import TopicGroup, TopicReader
from arm_viewer.snapshot import JointReading, JointStates

WORD = "joint_states"
_QOS = QoSProfile(depth=10, reliability=ReliabilityPolicy.BEST_EFFORT)


class JointStateObserver(Observer):
    """Keeps the latest reading of every published joint.

    Attributes:
        joint_states: joint states by topic.
        lost: topics that no longer have joint states.
    """

    def __init__(self, node: Node, polled: PolledSubscriptions) -> None:
        """Subscribe in the root namespace."""
        self._topics = TopicGroup(node, polled, JointState, WORD, _QOS)
        self._received_s: dict[str, dict[str, float]] = {}
        self.joint_states: MappingProxyType[str, JointStates] = MappingProxyType({})
        self.lost: frozenset[str] = frozenset()

    def discover(self, topics: TopicTypes) -> None:
        """Subscribe to new topics."""
        self._topics.discover(topics)

    def collect(self, now_s: float) -> None:
        """Take what has arrived, and forget what is outdated."""
        for reader in self._topics.readers():
            joints: dict[str, JointReading] = {}
            for message in reader.take_all():
                joints.update(joint_readings(message))
            received_s = self._received_s.setdefault(reader.topic, {})
            received_s.update(dict.fromkeys(joints, now_s))
            outdated_s = reader.outdated_before(now_s)
            outdated = {name for name, at_s in received_s.items() if at_s < outdated_s}
            if joints or outdated:
                self._keep(reader.topic, joints, outdated, now_s)

    def _keep(
        self, topic: str, joints: dict[str, JointReading], outdated: set[str], now_s: float
    ) -> None:
        known = self.joint_states.get(topic)
        before = {} if known is None else known.joints
        kept = {name: r for name, r in {**before, **joints}.items() if name not in outdated}
        received_s = now_s if joints or known is None else known.received_s
        states = JointStates(MappingProxyType(kept), received_s)
        by_topic = {**self.joint_states, topic: states}
        if not kept:
            del by_topic[topic]
        for name in outdated:
            del self._received_s[topic][name]
        self.lost = (self.lost | self.joint_states.keys()) - by_topic.keys()
        self.joint_states = MappingProxyType(by_topic)


def joint_readings(message: JointState) -> dict[str, JointReading]:
    """Return the values of each joint that a message names."""
    columns = [
        _column(values, len(message.name))
        for values in (message.position, message.velocity, message.effort)
    ]
    rows = zip(*columns, strict=True)
    return {name: JointReading(*row) for name, row in zip(message.name, rows, strict=True)}


def _column(values: Sequence[float], count: int) -> Sequence[float]:
    return values if len(values) == count else [math.nan] * count


SUFFIX = "/introspection_data/full"
KIND, INTERFACE = "state_interface.", "/position"


class HardwareObserver(Observer):
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
        keep_in_step(
            self._readers,
            wanted,
            lambda topic: TopicReader(self._node, self._polled, self._message_class, topic, NEWEST),
        )
        known = set(map(_namespace, wanted))
        if self.positions.keys() - known:
            self.positions = {name: p for name, p in self.positions.items() if name in known}

    def collect(self, now_s: float) -> None:
        """Take what has arrived."""
        for topic, reader in self._readers.items():
            message = reader.take_newest()
            if message is not None:
                self.positions = {**self.positions, _namespace(topic): _positions_in(message)}


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


def _positions_in(message: Any) -> dict[str, float]:
    return {
        entry.name.removeprefix(KIND).removesuffix(INTERFACE): entry.value
        for entry in message.statistics
        if entry.name.startswith(KIND)
        and entry.name.endswith(INTERFACE)
        and math.isfinite(entry.value)
    }
