"""Reads one topic now and then, instead of at every message."""

from collections.abc import Iterator
from typing import Any, Generic, TypeVar

from rclpy.node import Node
from rclpy.qos import QoSProfile
from rclpy.serialization import deserialize_message

from arm_node.polled_subscriptions import PolledSubscriptions

Message = TypeVar("Message")


class TopicReader(Generic[Message]):
    """A subscription whose messages are fetched. Use it in the executor's thread."""

    def __init__(
        self,
        node: Node,
        polled: PolledSubscriptions,
        message_class: type[Message],
        topic: str,
        profile: QoSProfile,
    ) -> None:
        """Subscribe; what the profile's depth does not hold between two looks is lost."""
        self.topic = topic
        self._node = node
        self._message_class = message_class
        self._polled = polled
        self._depth = profile.depth
        self._subscription = polled.subscribe(message_class, topic, profile)

    def take_all(self) -> Iterator[Message]:
        """Yield what has come since the last time, oldest first."""
        for data in self._take():
            yield deserialize_message(data, self._message_class)  # pyright: ignore[reportReturnType]

    def take_newest(self) -> Message | None:
        """Return the newest that has come since the last time, None where nothing has."""
        newest: Any = None
        for newest in self._take():  # noqa: B007
            pass
        if newest is None:
            return None
        return deserialize_message(newest, self._message_class)  # pyright: ignore[reportReturnType]

    def publisher_count(self) -> int:
        """Return how many publish on the topic, as far as is known."""
        return self._node.count_publishers(self.topic)

    def close(self) -> None:
        """End the subscription."""
        self._node.destroy_subscription(self._subscription)

    def _take(self) -> Iterator[bytes]:
        for data, _ in self._polled.take(self._subscription, self._depth):
            yield data
