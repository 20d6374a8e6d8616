"""Readers of one topic, and of all topics of the same name in any namespace."""

import math
import time
from collections.abc import Iterator
from functools import partial
from typing import Any, Generic, TypeVar

from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.serialization import deserialize_message

from arm_node.polled_subscriptions import PolledSubscriptions
from arm_viewer.ros.observer import TopicTypes, topics_of

Message = TypeVar("Message")

REPEAT_S = 2.0
"""A live publisher repeats its state within this time."""


class TopicReader(Generic[Message]):
    """A polled subscription. Use it in the executor's thread."""

    def __init__(
        self,
        node: Node,
        polled: PolledSubscriptions,
        message_class: type[Message],
        topic: str,
        profile: QoSProfile,
    ) -> None:
        """Subscribe; messages beyond the profile's depth are lost between two polls."""
        self.topic = topic
        self._node = node
        self._message_class = message_class
        self._polled = polled
        self._profile = profile
        self._subscription = polled.subscribe(message_class, topic, profile)
        self._publishers: frozenset[bytes] = frozenset()
        self._heard = False
        self._left_s = math.nan

    def take_all(self) -> Iterator[Message]:
        """Yield the messages since the last call, oldest first."""
        for data in self._take():
            yield deserialize_message(data, self._message_class)  # pyright: ignore[reportReturnType]

    def take_newest(self) -> Message | None:
        """Return the latest message since the last call, or None."""
        newest: Any = None
        for newest in self._take():  # noqa: B007
            pass
        if newest is None:
            return None
        return deserialize_message(newest, self._message_class)  # pyright: ignore[reportReturnType]

    def look_for_publishers(self, now_s: float) -> None:
        """Check whether a publisher has disappeared; call it periodically."""
        found = self._node.get_publishers_info_by_topic(self.topic)
        publishers = frozenset(bytes(end.endpoint_gid) for end in found)
        # A publisher that came and went between two checks was heard but never listed.
        if self._publishers - publishers or (self._heard and not publishers):
            self.expect_again(now_s)
        self._publishers = publishers

    def expect_again(self, now_s: float) -> None:
        """Mark everything received so far as outdated unless it is repeated soon."""
        self._left_s = now_s
        if self._profile.durability == DurabilityPolicy.TRANSIENT_LOCAL:
            # Live publishers repeat their last message to a new subscription.
            self.close()
            self._subscription = self._polled.subscribe(
                self._message_class, self.topic, self._profile
            )
        else:
            # Drop messages from the publisher that has disappeared.
            for _ in self._take():
                pass
        self._heard = False

    def outdated_before(self, now_s: float) -> float:
        """Return, once, the time before which received data is outdated; else -infinity."""
        left_s = self._left_s
        if math.isnan(left_s) or (self._publishers and now_s - left_s < REPEAT_S):
            return -math.inf
        self._left_s = math.nan
        return left_s

    def close(self) -> None:
        """End the subscription."""
        self._node.destroy_subscription(self._subscription)

    def _take(self) -> Iterator[bytes]:
        for data, _ in self._polled.take(self._subscription, self._profile.depth):
            self._heard = True
            yield data


class TopicGroup(Generic[Message]):
    """A reader for each topic of a name: "joint_states" means /joint_states, /left/joint_states...

    The topic in the root namespace is subscribed from the start, so that its messages do not wait
    for discovery.
    """

    def __init__(
        self,
        node: Node,
        polled: PolledSubscriptions,
        message_class: type[Message],
        word: str,
        profile: QoSProfile,
    ) -> None:
        """Subscribe to the topic in the root namespace."""
        self._node = node
        self._message_class = message_class
        self._suffix = f"/{word}"
        self._reader = partial(TopicReader, node, polled, message_class, profile=profile)
        self._readers: dict[str, TopicReader[Message]] = {self._suffix: self._reader(self._suffix)}

    def discover(self, topics: TopicTypes) -> None:
        """Subscribe to new topics, and check the others for publishers that have disappeared."""
        for topic in topics_of(self._message_class, topics, self._node) - self._readers.keys():
            if topic.endswith(self._suffix):
                self._readers[topic] = self._reader(topic)
        now_s = time.monotonic()
        for reader in self._readers.values():
            reader.look_for_publishers(now_s)

    def readers(self) -> Iterator[TopicReader[Message]]:
        """Yield the readers."""
        yield from self._readers.values()
