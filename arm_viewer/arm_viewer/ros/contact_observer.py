"""Observe contacts on all topics called contact_markers, in any namespace, while they are shown."""

import numpy as np
from numpy.typing import NDArray
from rclpy.node import Node
from visualization_msgs.msg import Marker, MarkerArray

from arm_node.polled_subscriptions import PolledSubscriptions
from arm_node.qos import LATCHED
from arm_viewer.ros.observer import Observer, TopicTypes
from arm_viewer.ros.topic_reader import TopicGroup
from arm_viewer.snapshot import ContactForces, frame_name

WORD = "contact_markers"


class ContactObserver(Observer):
    """Keeps the latest contacts of one simulation; subscribes only while they are wanted."""

    def __init__(self, node: Node, polled: PolledSubscriptions) -> None:
        """Start without a subscription."""
        self._node = node
        self._polled = polled
        self._topics: TopicGroup[MarkerArray] | None = None
        self._received_s = 0.0
        self.contacts: ContactForces | None = None

    def show(self, wanted: bool) -> None:
        """Subscribe, or end the subscription and forget the contacts."""
        if wanted and self._topics is None:
            self._topics = TopicGroup(self._node, self._polled, MarkerArray, WORD, LATCHED)
        elif not wanted and self._topics is not None:
            for reader in self._topics.readers():
                reader.close()
            self._topics, self.contacts = None, None

    def discover(self, topics: TopicTypes) -> None:
        """Subscribe to new topics."""
        if self._topics is not None:
            self._topics.discover(topics)

    def collect(self, now_s: float) -> None:
        """Take what has arrived; without a publisher nothing is known."""
        if self._topics is None:
            return
        for reader in self._topics.readers():
            message = reader.take_newest()
            if message is not None:
                self.contacts, self._received_s = contact_forces(message), now_s
            if self._received_s < reader.outdated_before(now_s):
                self.contacts = None


def contact_forces(message: MarkerArray) -> ContactForces:
    """Return the contacts of a message."""
    found = {m.type: m for m in message.markers if m.action == Marker.ADD}
    points, forces = found.get(Marker.SPHERE_LIST), found.get(Marker.LINE_LIST)
    if points is None or forces is None:
        points, forces = Marker(), Marker()
    ends = _places(forces)
    lines = ends[: len(ends) // 2 * 2].reshape(-1, 2, 3)
    return ContactForces(
        frame_name(points.header.frame_id), _places(points), lines, tuple(forces.text.splitlines())
    )


def _places(marker: Marker) -> NDArray[np.float32]:
    places = np.array([(p.x, p.y, p.z) for p in marker.points], dtype=np.float32)
    return np.nan_to_num(places.reshape(-1, 3), nan=0.0, posinf=0.0, neginf=0.0)
