"""Observe the graph: its topics with their rates, and its nodes."""

import math
from collections import Counter, deque
from collections.abc import Callable, Sequence
from importlib import import_module

from rclpy.node import Node, NodeNameNonExistentError
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rclpy.subscription import Subscription

from arm_node.drawing import NodeTopics
from arm_node.polled_subscriptions import PolledSubscriptions
from arm_viewer.ros.observer import TopicTypes, used_types
from arm_viewer.snapshot import Topic

WINDOW_S = 3.0
DEPTH = 100
"""Limit on the messages counted between two collections, which corresponds to 3 kHz."""
_QOS = QoSProfile(depth=DEPTH, reliability=ReliabilityPolicy.BEST_EFFORT)


class TopicObserver:
    """Lists the topics of other nodes; subscribes to all of them while rates are wanted."""

    def __init__(self, node: Node, polled: PolledSubscriptions) -> None:
        """Start without measuring rates."""
        self._node = node
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
                rate_hz = meter.rate_hz() if meter else math.nan
                found.append(Topic(name, tuple(types), publishers, max(subscriptions, 0), rate_hz))
        self.topics = tuple(found)
        if self._measured:
            self._keep_meters([t for t in found if t.publishers > 0])

    def collect(self, now_s: float) -> None:
        """Count the messages that have arrived."""
        for meter in self._meters.values():
            meter.count(now_s)

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
            message_class = _message_class(types[name])
            if message_class is not None:
                subscription = self._polled.subscribe(message_class, name, _QOS)
                self._meters[name] = _RateMeter(self._polled, subscription)


class _RateMeter:
    """Counts the messages of one topic, without reading them."""

    def __init__(self, polled: PolledSubscriptions, subscription: Subscription) -> None:
        self.subscription = subscription
        self._polled = polled
        self._counts: deque[tuple[float, int]] = deque()

    def count(self, now_s: float) -> None:
        count = sum(1 for _ in self._polled.take(self.subscription, DEPTH))
        self._counts.append((now_s, count))
        while self._counts[0][0] < now_s - WINDOW_S:
            self._counts.popleft()

    def rate_hz(self) -> float:
        """Return the mean of the window; NaN before there are two counts."""
        if len(self._counts) < 2:
            return math.nan
        # The messages of the first count arrived before the window.
        total = sum(count for _, count in self._counts) - self._counts[0][1]
        return total / (self._counts[-1][0] - self._counts[0][0])


def _message_class(message_type: str) -> type | None:
    """Return the class of a type; None if its package is not installed."""
    package, _, name = message_type.partition("/msg/")
    try:
        return getattr(import_module(f"{package}.msg"), name)
    except (ImportError, AttributeError):
        return None


NamesAndTypes = list[tuple[str, list[str]]]


class NodeObserver:
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

    def collect(self, now_s: float) -> None:
        """Do nothing: `discover` reads the graph once a second."""

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
