"""Where the frames are, from /tf and /tf_static."""

import math
from types import MappingProxyType

from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from tf2_msgs.msg import TFMessage

from arm_node.polled_subscriptions import PolledSubscriptions
from arm_viewer.frame_name import frame_name
from arm_viewer.ros.observer import TopicTypes
from arm_viewer.ros.topic_reader import TopicReader
from arm_viewer.snapshot import Transform

_TF_QOS = QoSProfile(depth=100)
_STATIC_QOS = QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class TransformObserver:
    """Keeps the newest transform of every frame.

    What came from publishers of which none is left stays to be seen, until another one comes.
    """

    def __init__(self, node: Node, polled: PolledSubscriptions) -> None:
        """Subscribe to both topics."""
        self._topics = (
            TopicReader(node, polled, TFMessage, "/tf_static", _STATIC_QOS),
            TopicReader(node, polled, TFMessage, "/tf", _TF_QOS),
        )
        self._abandoned = False
        self.transforms: MappingProxyType[str, Transform] = MappingProxyType({})

    def discover(self, topics: TopicTypes) -> None:
        """Notice whether anybody is left who publishes."""
        if not any(reader.publisher_count() for reader in self._topics):
            self._abandoned = True

    def collect(self, now_s: float) -> None:
        """Take what has arrived."""
        new: dict[str, Transform] = {}
        for reader in self._topics:
            for message in reader.take_all():
                new.update(_read(message))
        if new:
            kept = {} if self._abandoned else self.transforms
            self._abandoned = False
            self.transforms = MappingProxyType({**kept, **new})


def _read(message: TFMessage) -> dict[str, Transform]:
    result: dict[str, Transform] = {}
    for stamped in message.transforms:
        parent, child = frame_name(stamped.header.frame_id), frame_name(stamped.child_frame_id)
        move, turn = stamped.transform.translation, stamped.transform.rotation
        position, rotation = (move.x, move.y, move.z), (turn.x, turn.y, turn.z, turn.w)
        # tf2 refuses the same: no name, a frame in itself, what is no number, what is no rotation.
        if (
            len({"", parent, child}) == 3
            and all(map(math.isfinite, (*position, *rotation)))
            and abs(math.hypot(*rotation) - 1.0) < 0.01
        ):
            result[child] = Transform(parent, position, rotation)
    return result
