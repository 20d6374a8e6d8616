"""Topics of one type that share their last word, in whatever namespaces."""

from collections.abc import Iterator
from typing import Generic, TypeVar

from rclpy.node import Node
from rclpy.qos import QoSProfile

from arm_node.polled_subscriptions import PolledSubscriptions
from arm_viewer.ros.observer import TopicTypes
from arm_viewer.ros.topic_reader import TopicReader
from arm_viewer.ros.topic_types import topics_of

Message = TypeVar("Message")


class TopicFamily(Generic[Message]):
    """A reader for each of them: "joint_states" stands for /joint_states, /left/joint_states...

    The one in the root namespace is subscribed from the start, so that its messages need not wait
    for the discovery.
    """

    def __init__(
        self,
        node: Node,
        polled: PolledSubscriptions,
        message_class: type[Message],
        word: str,
        profile: QoSProfile,
    ) -> None:
        """Subscribe the one in the root namespace."""
        self._node = node
        self._polled = polled
        self._message_class = message_class
        self._suffix = f"/{word}"
        self._profile = profile
        self._readers: dict[str, TopicReader[Message]] = {}
        self._subscribe(self._suffix)

    def discover(self, topics: TopicTypes) -> None:
        """Subscribe to those that are new."""
        for topic in topics_of(self._message_class, topics, self._node) - self._readers.keys():
            if topic.endswith(self._suffix):
                self._subscribe(topic)

    def readers(self) -> Iterator[TopicReader[Message]]:
        """Yield the readers."""
        yield from self._readers.values()

    def _subscribe(self, topic: str) -> None:
        self._readers[topic] = TopicReader(
            self._node, self._polled, self._message_class, topic, self._profile
        )
