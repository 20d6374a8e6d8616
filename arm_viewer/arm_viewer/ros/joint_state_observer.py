"""The newest joint states of every topic whose last word is joint_states."""

import math
from collections.abc import Sequence
from types import MappingProxyType

from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import JointState

from arm_node.polled_subscriptions import PolledSubscriptions
from arm_viewer.ros.observer import TopicTypes
from arm_viewer.ros.topic_family import TopicFamily
from arm_viewer.snapshot import JointReading, JointStates

WORD = "joint_states"
_QOS = QoSProfile(depth=10, reliability=ReliabilityPolicy.BEST_EFFORT)


class JointStateObserver:
    """Keeps the newest reading of every joint."""

    def __init__(self, node: Node, polled: PolledSubscriptions) -> None:
        """Start to look."""
        self._topics = TopicFamily(node, polled, JointState, WORD, _QOS)
        self.joint_states: MappingProxyType[str, JointStates] = MappingProxyType({})

    def discover(self, topics: TopicTypes) -> None:
        """Subscribe to new topics."""
        self._topics.discover(topics)

    def collect(self, now_s: float) -> None:
        """Take what has arrived."""
        for reader in self._topics.readers():
            joints: dict[str, JointReading] = {}
            for message in reader.take_all():
                joints.update(_read(message))
            if joints:
                known = self.joint_states.get(reader.topic)
                before = {} if known is None else known.joints
                states = JointStates(MappingProxyType({**before, **joints}), now_s)
                self.joint_states = MappingProxyType({**self.joint_states, reader.topic: states})


def _read(message: JointState) -> dict[str, JointReading]:
    columns = [
        _column(values, len(message.name))
        for values in (message.position, message.velocity, message.effort)
    ]
    rows = zip(*columns, strict=True)
    return {name: JointReading(*row) for name, row in zip(message.name, rows, strict=True)}


def _column(values: Sequence[float], count: int) -> Sequence[float]:
    return values if len(values) == count else [math.nan] * count
