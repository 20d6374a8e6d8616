"""Observe the cameras' intrinsics, and the images that the page shows."""

import math
from types import MappingProxyType

import numpy as np
from rclpy.node import Node
from sensor_msgs.msg import CameraInfo, Image

from arm_node.polled_subscriptions import PolledSubscriptions
from arm_node.qos import NEWEST
from arm_viewer.requests import ShowPictures
from arm_viewer.ros.observer import (
    Observer,
    TopicTypes,
    keep_in_step,
    topics_of,
    type_name,
    used_types,
)
from arm_viewer.ros.topic_reader import TopicReader
from arm_viewer.snapshot import CameraView, Picture, frame_name

_IMAGE_TYPE = type_name(Image)


class CameraObserver(Observer):
    """Keeps the latest intrinsics of every published camera, without its images."""

    def __init__(self, node: Node, polled: PolledSubscriptions) -> None:
        """Start without cameras."""
        self._node = node
        self._polled = polled
        self._readers: dict[str, TopicReader[CameraInfo]] = {}
        self.views: MappingProxyType[str, CameraView] = MappingProxyType({})

    def discover(self, topics: TopicTypes) -> None:
        """Subscribe to new cameras, and forget cameras that are no longer published."""
        named = topics_of(CameraInfo, topics, self._node)
        found = {topic for topic in named if self._node.count_publishers(topic)}
        keep_in_step(
            self._readers,
            found,
            lambda topic: TopicReader(self._node, self._polled, CameraInfo, topic, NEWEST),
        )
        if self.views.keys() - found:
            self._keep({topic: view for topic, view in self.views.items() if topic in found})

    def collect(self, now_s: float) -> None:
        """Take what has arrived."""
        views = dict(self.views)
        for topic, reader in self._readers.items():
            message = reader.take_newest()
            if message is None:
                continue
            view = camera_view(message)
            if view is None:
                views.pop(topic, None)
            else:
                views[topic] = view
        if views != self.views:
            self._keep(views)

    def _keep(self, views: dict[str, CameraView]) -> None:
        self.views = MappingProxyType(views)


def camera_view(message: CameraInfo) -> CameraView | None:
    """Return the view, or None if the intrinsics are zero or not finite."""
    fx, _, cx, _, fy, cy = (float(value) for value in message.k[:6])
    frame = frame_name(message.header.frame_id)
    sizes = (message.width, message.height, fx, fy)
    if not frame or min(sizes) <= 0.0 or not all(map(math.isfinite, (*sizes, cx, cy))):
        return None
    return CameraView(frame, message.width, message.height, (fx, fy), (cx, cy))


class ImageObserver(Observer):
    """Lists all image topics, and keeps the latest image of the requested ones."""

    def __init__(self, node: Node, polled: PolledSubscriptions) -> None:
        """Start without requested images."""
        self._node = node
        self._polled = polled
        self._readers: dict[str, TopicReader[Image]] = {}
        self.topics: tuple[str, ...] = ()
        self.pictures: MappingProxyType[str, Picture] = MappingProxyType({})

    def serve(self, request: ShowPictures) -> None:
        """Subscribe to the requested topics, and end the other subscriptions."""
        # This node may use a topic with another type by now.
        used = used_types(self._node)
        keep_in_step(
            self._readers,
            {topic for topic in request.topics if used.get(topic, _IMAGE_TYPE) == _IMAGE_TYPE},
            lambda topic: TopicReader(self._node, self._polled, Image, topic, NEWEST),
        )
        kept = {t: picture for t, picture in self.pictures.items() if t in request.topics}
        self.pictures = MappingProxyType(kept)

    def discover(self, topics: TopicTypes) -> None:
        """List the published topics."""
        named = topics_of(Image, topics, self._node)
        self.topics = tuple(sorted(t for t in named if self._node.count_publishers(t)))

    def collect(self, now_s: float) -> None:
        """Take what has arrived."""
        new = {}
        for topic, reader in self._readers.items():
            message = reader.take_newest()
            if message is not None:
                new[topic] = picture_of(message)
        if new:
            self.pictures = MappingProxyType({**self.pictures, **new})


def picture_of(message: Image) -> Picture:
    """Return an image as received."""
    return Picture(
        encoding=message.encoding,
        width=message.width,
        height=message.height,
        step=message.step,
        is_bigendian=bool(message.is_bigendian),
        data=np.frombuffer(message.data, dtype=np.uint8),
    )
