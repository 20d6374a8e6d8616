"""The images of the topics that are to be seen."""

from types import MappingProxyType

import numpy as np
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import Image

from arm_node.polled_subscriptions import PolledSubscriptions
from arm_viewer.requests import ShowPictures
from arm_viewer.ros.observer import TopicTypes
from arm_viewer.ros.topic_reader import TopicReader
from arm_viewer.ros.topic_types import topics_of, type_name, used_types
from arm_viewer.snapshot import Picture

_QOS = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
_TYPE = type_name(Image)


class ImageObserver:
    """Knows all image topics, and keeps the newest image of those that are wanted."""

    def __init__(self, node: Node, polled: PolledSubscriptions) -> None:
        """Start to look; nothing is wanted yet."""
        self._node = node
        self._polled = polled
        self._readers: dict[str, TopicReader[Image]] = {}
        self.topics: tuple[str, ...] = ()
        self.pictures: MappingProxyType[str, Picture] = MappingProxyType({})

    def serve(self, request: ShowPictures) -> None:
        """Subscribe to what is wanted, and end the other subscriptions."""
        for topic in self._readers.keys() - request.topics:
            self._readers.pop(topic).close()
        used = used_types(self._node)
        for topic in request.topics - self._readers.keys():
            # Since the page has heard of it something else of this node may have taken it.
            if used.get(topic, _TYPE) == _TYPE:
                self._readers[topic] = TopicReader(self._node, self._polled, Image, topic, _QOS)
        kept = {t: picture for t, picture in self.pictures.items() if t in request.topics}
        self.pictures = MappingProxyType(kept)

    def discover(self, topics: TopicTypes) -> None:
        """Note the topics that somebody publishes."""
        named = topics_of(Image, topics, self._node)
        self.topics = tuple(sorted(t for t in named if self._node.count_publishers(t)))

    def collect(self, now_s: float) -> None:
        """Take what has arrived."""
        new = {}
        for topic, reader in self._readers.items():
            message = reader.take_newest()
            if message is not None:
                new[topic] = _read(message)
        if new:
            self.pictures = MappingProxyType({**self.pictures, **new})


def _read(message: Image) -> Picture:
    return Picture(
        encoding=message.encoding,
        width=message.width,
        height=message.height,
        step=message.step,
        is_bigendian=bool(message.is_bigendian),
        data=np.frombuffer(message.data, dtype=np.uint8),
    )
