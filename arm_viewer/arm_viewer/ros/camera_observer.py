"""What cameras see, from the topics of their intrinsics."""

import math
from types import MappingProxyType

from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import CameraInfo

from arm_node.polled_subscriptions import PolledSubscriptions
from arm_viewer.frame_name import frame_name
from arm_viewer.ros.observer import TopicTypes
from arm_viewer.ros.topic_reader import TopicReader
from arm_viewer.ros.topic_types import topics_of
from arm_viewer.snapshot import CameraView

_QOS = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)


class CameraObserver:
    """Keeps the newest view of every camera that somebody publishes, without its images."""

    def __init__(self, node: Node, polled: PolledSubscriptions) -> None:
        """Start to look."""
        self._node = node
        self._polled = polled
        self._readers: dict[str, TopicReader[CameraInfo]] = {}
        self.views: MappingProxyType[str, CameraView] = MappingProxyType({})

    def discover(self, topics: TopicTypes) -> None:
        """Subscribe to new cameras, and forget those that are gone."""
        named = topics_of(CameraInfo, topics, self._node)
        found = {topic for topic in named if self._node.count_publishers(topic)}
        for topic in self._readers.keys() - found:
            self._readers.pop(topic).close()
        for topic in found - self._readers.keys():
            self._readers[topic] = TopicReader(self._node, self._polled, CameraInfo, topic, _QOS)
        if self.views.keys() - found:
            self._keep({topic: view for topic, view in self.views.items() if topic in found})

    def collect(self, now_s: float) -> None:
        """Take what has arrived."""
        views = dict(self.views)
        for topic, reader in self._readers.items():
            message = reader.take_newest()
            if message is None:
                continue
            view = _read(message)
            if view is None:
                views.pop(topic, None)
            else:
                views[topic] = view
        if views != self.views:
            self._keep(views)

    def _keep(self, views: dict[str, CameraView]) -> None:
        self.views = MappingProxyType(views)


def _read(message: CameraInfo) -> CameraView | None:
    """Return the view; None of a camera that does not say how it sees, by zeros or otherwise."""
    fx, _, cx, _, fy, cy = (float(value) for value in message.k[:6])
    frame = frame_name(message.header.frame_id)
    sizes = (message.width, message.height, fx, fy)
    if not frame or min(sizes) <= 0.0 or not all(map(math.isfinite, (*sizes, cx, cy))):
        return None
    return CameraView(frame, message.width, message.height, (fx, fy), (cx, cy))
