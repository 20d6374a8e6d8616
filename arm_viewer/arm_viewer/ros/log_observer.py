"""Observe what nodes log and diagnose."""

from collections.abc import Mapping
from types import MappingProxyType

from diagnostic_msgs.msg import DiagnosticArray
from rcl_interfaces.msg import Log
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

from arm_node.polled_subscriptions import PolledSubscriptions
from arm_viewer.ros.observer import Observer
from arm_viewer.ros.topic_reader import TopicReader
from arm_viewer.snapshot import ComponentStatus, LogEntry

KEPT = 5000
MAX_LENGTH = 4000
"""Longer messages are cut."""
_LATCHED = QoSProfile(depth=1000, durability=DurabilityPolicy.TRANSIENT_LOCAL)
_QOS = QoSProfile(depth=100, reliability=ReliabilityPolicy.BEST_EFFORT)


class LogObserver(Observer):
    """Keeps the newest messages of /rosout; what was said stays."""

    def __init__(self, node: Node, polled: PolledSubscriptions) -> None:
        """Subscribe; nodes repeat what they said in the last seconds."""
        self._reader = TopicReader(node, polled, Log, "/rosout", _LATCHED)
        self._number = 0
        self.entries: tuple[LogEntry, ...] = ()

    def collect(self, now_s: float) -> None:
        """Take what has arrived."""
        new = [self._entry(message) for message in self._reader.take_all()]
        if new:
            self.entries = (*self.entries, *new)[-KEPT:]

    def _entry(self, message: Log) -> LogEntry:
        self._number += 1
        return LogEntry(
            number=self._number,
            time_s=message.stamp.sec + 1e-9 * message.stamp.nanosec,
            level=message.level,
            node=message.name,
            text=message.msg[:MAX_LENGTH],
            place=f"{message.function} {message.file}:{message.line}".strip(),
        )


class DiagnosticObserver(Observer):
    """Keeps the last status of each component on /diagnostics; the page shows how old it is."""

    def __init__(self, node: Node, polled: PolledSubscriptions) -> None:
        """Subscribe."""
        self._reader = TopicReader(node, polled, DiagnosticArray, "/diagnostics", _QOS)
        self.diagnoses: Mapping[str, ComponentStatus] = MappingProxyType({})

    def collect(self, now_s: float) -> None:
        """Take what has arrived."""
        new = {
            status.name: ComponentStatus(
                level=int.from_bytes(status.level),
                text=status.message,
                hardware=status.hardware_id,
                values=tuple((pair.key, pair.value) for pair in status.values),
                received_s=now_s,
            )
            for message in self._reader.take_all()
            for status in message.status
        }
        if new:
            self.diagnoses = MappingProxyType({**self.diagnoses, **new})
