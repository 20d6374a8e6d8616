"""Observe numbers in the messages of any topic: which there are, and their curves."""

from collections.abc import Iterable, Mapping
from types import MappingProxyType
from typing import Any

import numpy as np
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rclpy.serialization import deserialize_message
from rclpy.subscription import Subscription

from arm_node.polled_subscriptions import PolledSubscriptions
from arm_viewer.plots.field_paths import NumberPath, numbers_in, parse_curve, reader
from arm_viewer.plots.history import Curves, GapFinder
from arm_viewer.requests import ListNumbers, PlotCurves
from arm_viewer.ros.graph_observer import message_class_of
from arm_viewer.ros.observer import Observer, TopicTypes, used_types

DEPTH = 1000
"""No message of 500 Hz is lost, even if the page does nothing for two seconds."""


class FieldObserver(Observer):
    """Subscribes to the topics of the curves that are wanted, and reads their numbers."""

    def __init__(self, node: Node, polled: PolledSubscriptions) -> None:
        """Start without curves."""
        self._node = node
        self._polled = polled
        self._types: TopicTypes = {}
        self._wanted: dict[str, list[NumberPath]] = {}
        self._readers: dict[str, _CurveReader] = {}
        self._unread: dict[str, Subscription] = {}
        self.curves = Curves()
        self.numbers: Mapping[str, tuple[str, ...]] = MappingProxyType({})

    def serve(self, request: PlotCurves | ListNumbers) -> None:
        """Start at once with what is wanted."""
        if isinstance(request, ListNumbers):
            self._look()
            return
        self._wanted = {}
        for name in sorted(request.names):
            curve = parse_curve(name)
            self._wanted.setdefault(curve.topic, []).append(curve)
        self.curves.keep(request.names)
        self._read()

    def discover(self, topics: TopicTypes) -> None:
        """Begin to read topics that have appeared."""
        self._types = topics
        self._read()

    def collect(self, now_s: float) -> None:
        """Take what has arrived."""
        for found in self._readers.values():
            found.collect(self._polled, self.curves)
        for topic, subscription in tuple(self._unread.items()):
            for data, _ in self._polled.take(subscription, 1):
                message = deserialize_message(data, subscription.msg_type)
                self._offer(topic, message)
                self._node.destroy_subscription(self._unread.pop(topic))

    def _read(self) -> None:
        for topic in self._readers.keys() - self._wanted.keys():
            self._node.destroy_subscription(self._readers.pop(topic).subscription)
        for topic, curves in self._wanted.items():
            found = self._readers.get(topic)
            if found is not None:
                found.read(curves)
            elif (subscription := self._subscribe(topic, DEPTH)) is not None:
                self._readers[topic] = _CurveReader(subscription, curves)

    def _look(self) -> None:
        """Wait for one message of each topic; whoever asks again waits for those that come."""
        for topic in self._unread.keys() - self._types.keys():
            self._node.destroy_subscription(self._unread.pop(topic))
        self.numbers = MappingProxyType(
            {topic: paths for topic, paths in self.numbers.items() if topic in self._types}
        )
        for topic in self._types:
            if topic not in self.numbers and "/_" not in topic:
                subscription = self._subscribe(topic, 1)
                if subscription is not None:
                    self._unread[topic] = subscription
                    message_class: Any = subscription.msg_type
                    self._offer(topic, message_class())

    def _offer(self, topic: str, message: Any) -> None:
        """Offer the numbers of a message; an empty one lacks what is in arrays."""
        self.numbers = MappingProxyType({**self.numbers, topic: tuple(numbers_in(message))})

    def _subscribe(self, topic: str, depth: int) -> Subscription | None:
        types = self._types.get(topic, ())
        # Of several types only the one that this node already uses can be subscribed to.
        kind = used_types(self._node).get(topic, types[0] if len(types) == 1 else "")
        message_class = message_class_of(kind)
        if message_class is None:
            return None
        return self._polled.subscribe(message_class, topic, self._profile(topic, depth))

    def _profile(self, topic: str, depth: int) -> QoSProfile:
        """Return a profile that gets the last message of a publisher that keeps it."""
        publishers = self._node.get_publishers_info_by_topic(topic)
        keeps = [p.qos_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL for p in publishers]
        if keeps and all(keeps):
            return QoSProfile(depth=depth, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        return QoSProfile(depth=depth, reliability=ReliabilityPolicy.BEST_EFFORT)


class _CurveReader:
    """Reads the curves of one topic."""

    def __init__(self, subscription: Subscription, curves: Iterable[NumberPath]) -> None:
        self.subscription = subscription
        self._gaps = GapFinder()
        self.read(curves)

    def read(self, curves: Iterable[NumberPath]) -> None:
        self._fields = {curve.topic + "".join(curve.steps): reader(curve) for curve in curves}

    def collect(self, polled: PolledSubscriptions, curves: Curves) -> None:
        times: list[float] = []
        rows: list[list[float]] = []
        for data, information in polled.take(self.subscription, DEPTH):
            message = deserialize_message(data, self.subscription.msg_type)
            times.append(1e-9 * information["received_timestamp"])
            rows.append([read(message) for read in self._fields.values()])
        if times:
            found, columns = self._gaps.with_gaps(np.array(times), np.array(rows).T)
            curves.append(found, dict(zip(self._fields, columns, strict=True)))
