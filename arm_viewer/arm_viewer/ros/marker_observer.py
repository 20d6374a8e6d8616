"""Observe the world's shapes on all topics called world_markers, in any namespace."""

import math
from types import MappingProxyType

import numpy as np
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from visualization_msgs.msg import Marker as MarkerMessage
from visualization_msgs.msg import MarkerArray

from arm_node.polled_subscriptions import PolledSubscriptions
from arm_node.rigid_transform import RigidTransform
from arm_viewer.ros.observer import Observer, TopicTypes
from arm_viewer.ros.topic_reader import TopicGroup
from arm_viewer.snapshot import Marker, MarkerLook, MarkerShape, frame_name

WORD = "world_markers"
_QOS = QoSProfile(depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL)
_SHAPES = {
    MarkerMessage.CUBE: MarkerShape.BOX,
    MarkerMessage.SPHERE: MarkerShape.BALL,
    MarkerMessage.CYLINDER: MarkerShape.CYLINDER,
    MarkerMessage.MESH_RESOURCE: MarkerShape.MESH,
    MarkerMessage.TRIANGLE_LIST: MarkerShape.TRIANGLES,
}


class MarkerObserver(Observer):
    """Keeps the latest marker of each name; unsupported types are left out."""

    def __init__(self, node: Node, polled: PolledSubscriptions) -> None:
        """Subscribe in the root namespace."""
        self._topics = TopicGroup(node, polled, MarkerArray, WORD, _QOS)
        self._received_s: dict[str, float] = {}
        self.markers: MappingProxyType[str, Marker] = MappingProxyType({})

    def discover(self, topics: TopicTypes) -> None:
        """Subscribe to new topics."""
        self._topics.discover(topics)

    def collect(self, now_s: float) -> None:
        """Take what has arrived, and forget what is outdated."""
        for reader in self._topics.readers():
            received = [marker for message in reader.take_all() for marker in message.markers]
            outdated_s = reader.outdated_before(now_s)
            if not received and outdated_s < 0.0:
                continue
            markers = dict(self.markers)
            for marker in received:
                name = apply_marker(markers, reader.topic, marker)
                self._received_s[name] = now_s
            for name in [name for name in markers if name.startswith(f"{reader.topic}/")]:
                if self._received_s[name] < outdated_s:
                    del markers[name]
            self._received_s = {name: self._received_s[name] for name in markers}
            self.markers = MappingProxyType(markers)


def apply_marker(markers: dict[str, Marker], topic: str, message: MarkerMessage) -> str:
    """Apply a marker message to the markers, and return the name of its marker."""
    name = f"{topic}/{message.ns}/{message.id}"
    if message.action == MarkerMessage.DELETEALL:
        for known in [known for known in markers if known.startswith(f"{topic}/")]:
            del markers[known]
    elif message.action == MarkerMessage.DELETE:
        markers.pop(name, None)
    elif message.type in _SHAPES:
        marker = _read(message)
        if marker is not None:
            markers[name] = marker
    return name


def _read(message: MarkerMessage) -> Marker | None:
    move, turn = message.pose.position, message.pose.orientation
    position, rotation = (move.x, move.y, move.z), (turn.x, turn.y, turn.z, turn.w)
    scale = (message.scale.x, message.scale.y, message.scale.z)
    length = math.hypot(*rotation)
    if not all(map(math.isfinite, (*position, length, *scale))) or length == 0.0:
        return None
    rgba = (message.color.r, message.color.g, message.color.b, message.color.a)
    points = np.array([(p.x, p.y, p.z) for p in message.points], dtype=np.float32)
    look = MarkerLook(_SHAPES[message.type], scale, rgba, message.mesh_resource, points.tobytes())
    x, y, z, w = (component / length for component in rotation)
    return Marker(look, frame_name(message.header.frame_id), RigidTransform(position, (x, y, z, w)))
