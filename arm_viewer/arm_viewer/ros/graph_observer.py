"""Observe the graph: its topics with their rates, and its nodes."""

import math
import struct
import time
from collections import Counter, deque
from collections.abc import Callable, Sequence
from importlib import import_module
from typing import Any

from rclpy.node import Node, NodeNameNonExistentError
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rclpy.subscription import Subscription

from arm_node.drawing import NodeTopics
from arm_node.polled_subscriptions import PolledSubscriptions
from arm_viewer.ros.observer import Observer, TopicTypes, used_types
from arm_viewer.snapshot import SimulationTime, Topic

WINDOW_S = 3.0
DEPTH = 100
"""Limit on the messages counted between two collections, which corresponds to 3 kHz."""
_QOS = QoSProfile(depth=DEPTH, reliability=ReliabilityPolicy.BEST_EFFORT)


class TopicObserver(Observer):
    """Lists the topics of other nodes; subscribes to all of them while rates are wanted."""

    def __init__(
        self,
        node: Node,
        polled: PolledSubscriptions,
        clock: Callable[[], SimulationTime | None] = lambda: None,
    ) -> None:
        """Start without measuring; `clock` returns the simulation time, if there is one."""
        self._node = node
        self._clock = clock
        self._polled = polled
        self._measured = False
        self._meters: dict[str, _RateMeter] = {}
        self.topics: tuple[Topic, ...] = ()

    def measure(self, wanted: bool) -> None:
        """Start or stop measuring rates."""
        self._measured = wanted
        if not wanted:
            self._keep_meters(())

    def discover(self, topics: TopicTypes) -> None:
        """Count publishers and subscriptions of other nodes; measure published topics."""
        own_publishers = Counter(p.topic_name for p in self._node.publishers)
        own_subscriptions = Counter(s.topic_name for s in self._node.subscriptions)
        found: list[Topic] = []
        for name, types in sorted(topics.items()):
            publishers = self._node.count_publishers(name) - own_publishers[name]
            subscriptions = self._node.count_subscribers(name) - own_subscriptions[name]
            if (publishers > 0 or subscriptions > 0) and "/_" not in name:
                meter = self._meters.get(name)
                counts = (publishers, max(subscriptions, 0))
                measured = meter.result() if meter else (math.nan, math.nan, math.nan)
                found.append(Topic(name, tuple(types), *counts, *measured))
        self.topics = tuple(found)
        if self._measured:
            self._keep_meters([t for t in found if t.publishers > 0])

    def collect(self, now_s: float) -> None:
        """Count the messages that have arrived."""
        if not self._meters:
            return
        since_epoch_s = time.time()
        clock = self._clock()

        def time_of(received_s: float) -> float:
            """Return the time of a message's arrival on the clock of the stamps."""
            if clock is None:
                return received_s
            return clock.at(now_s - (since_epoch_s - received_s))

        for meter in self._meters.values():
            meter.count(now_s, time_of)

    def _keep_meters(self, topics: Sequence[Topic]) -> None:
        used = used_types(self._node, [meter.subscription for meter in self._meters.values()])
        # Of several types use the one that this node already uses. Otherwise measure nothing,
        # because the meter's subscription would block the other observers' type.
        types = {
            topic.name: used.get(topic.name, topic.types[0])
            for topic in topics
            if topic.name in used or len(topic.types) == 1
        }
        for name in self._meters.keys() - types.keys():
            self._node.destroy_subscription(self._meters.pop(name).subscription)
        for name in types.keys() - self._meters.keys():
            message_class = message_class_of(types[name])
            if message_class is not None:
                subscription = self._polled.subscribe(message_class, name, _QOS)
                self._meters[name] = _RateMeter(self._polled, subscription)


_STAMP = struct.Struct("<iI")
_STAMP_AT = 4
"""In a message that begins with a header, four bytes name the encoding, and the stamp follows."""


class _RateMeter:
    """Counts the messages of one topic and their bytes, and reads no more than their stamps."""

    def __init__(self, polled: PolledSubscriptions, subscription: Subscription) -> None:
        self.subscription = subscription
        self._polled = polled
        self._counts: deque[tuple[float, int, int, float]] = deque()
        message_class: Any = subscription.msg_type
        kinds = message_class.get_fields_and_field_types().values()
        self._is_stamped = next(iter(kinds), "") == "std_msgs/Header"

    def count(self, now_s: float, time_of: Callable[[float], float]) -> None:
        """Count what has arrived; `time_of` converts a time since the epoch to that of stamps."""
        count = size = 0
        delay_s = 0.0
        for data, information in self._polled.take(self.subscription, DEPTH):
            count += 1
            size += len(data)
            if self._is_stamped:
                sec, nanosec = _STAMP.unpack_from(data, _STAMP_AT)
                stamp_s = sec + 1e-9 * nanosec
                delay_s += time_of(1e-9 * information["received_timestamp"]) - stamp_s
                delay_s += 0.0 if stamp_s else math.nan
        self._counts.append((now_s, count, size, delay_s))
        while self._counts[0][0] < now_s - WINDOW_S:
            self._counts.popleft()

    def result(self) -> tuple[float, float, float]:
        """Return rate in Hz, bandwidth in bytes/s and mean delay in s; NaN before two counts."""
        if len(self._counts) < 2:
            return math.nan, math.nan, math.nan
        # The messages of the first count arrived before the window.
        count, size, delay_s = (sum(c) for c in list(zip(*self._counts, strict=True))[1:])
        first = self._counts[0]
        passed_s = self._counts[-1][0] - first[0]
        mean_s = delay_s / count if count and self._is_stamped else math.nan
        return (count - first[1]) / passed_s, (size - first[2]) / passed_s, mean_s


def message_class_of(message_type: str) -> type | None:
    """Return the class of a type; None if its package is not installed."""
    package, _, name = message_type.partition("/msg/")
    try:
        return getattr(import_module(f"{package}.msg"), name)
    except (ImportError, AttributeError):
        return None


NamesAndTypes = list[tuple[str, list[str]]]


class NodeObserver(Observer):
    """Lists the other nodes, sorted, with one entry for each name."""

    def __init__(self, node: Node) -> None:
        """Start with an empty list."""
        self._node = node
        self._own = node.get_fully_qualified_name()
        self.nodes: tuple[NodeTopics, ...] = ()

    def discover(self, topics: TopicTypes) -> None:
        """List the present nodes."""
        names = sorted(set(self._node.get_node_names_and_namespaces()))
        nodes = tuple(self._topics_of(name, namespace) for name, namespace in names)
        self.nodes = tuple(node for node in nodes if node.name != self._own)

    def _topics_of(self, name: str, namespace: str) -> NodeTopics:
        def topics(ask: Callable[[str, str], NamesAndTypes]) -> tuple[str, ...]:
            try:
                return tuple(sorted(topic for topic, _ in ask(name, namespace)))
            except NodeNameNonExistentError:
                # The node disappeared after it was listed.
                return ()

        return NodeTopics(
            f"{namespace.rstrip('/')}/{name}",
            topics(self._node.get_publisher_names_and_types_by_node),
            topics(self._node.get_subscriber_names_and_types_by_node),
        )
