"""Observe the transforms of frames on /tf and /tf_static."""

import math
import time
from types import MappingProxyType

from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from tf2_msgs.msg import TFMessage

from arm_node.polled_subscriptions import PolledSubscriptions
from arm_node.rigid_transform import RigidTransform
from arm_viewer.ros.observer import TopicTypes
from arm_viewer.ros.topic_reader import TopicReader
from arm_viewer.snapshot import Transform, frame_name

_TF_QOS = QoSProfile(depth=100)
_STATIC_QOS = QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class TransformObserver:
    """Keeps the latest transform of every published frame."""

    def __init__(self, node: Node, polled: PolledSubscriptions) -> None:
        """Subscribe to both topics."""
        self._topics = (
            TopicReader(node, polled, TFMessage, "/tf_static", _STATIC_QOS),
            TopicReader(node, polled, TFMessage, "/tf", _TF_QOS),
        )
        self._received_s: tuple[dict[str, float], ...] = ({}, {})
        self.transforms: MappingProxyType[str, Transform] = MappingProxyType({})

    def discover(self, topics: TopicTypes) -> None:
        """Check whether a publisher has disappeared."""
        now_s = time.monotonic()
        for reader in self._topics:
            reader.look_for_publishers(now_s)

    def expect_again(self, now_s: float) -> None:
        """Forget the frames that are not published again soon."""
        for reader in self._topics:
            reader.look_for_publishers(now_s)
            reader.expect_again(now_s)

    def collect(self, now_s: float) -> None:
        """Take what has arrived, and forget what is outdated."""
        new: dict[str, Transform] = {}
        outdated: set[str] = set()
        for reader, received_s in zip(self._topics, self._received_s, strict=True):
            for message in reader.take_all():
                read = _read(message)
                new.update(read)
                received_s.update(dict.fromkeys(read, now_s))
            outdated_s = reader.outdated_before(now_s)
            for frame in [frame for frame, at_s in received_s.items() if at_s <= outdated_s]:
                del received_s[frame]
                outdated.add(frame)
        # A frame may be published on both topics.
        outdated.difference_update(*self._received_s)
        if new or outdated:
            kept = {**self.transforms, **new}
            self.transforms = MappingProxyType(
                {frame: step for frame, step in kept.items() if frame not in outdated}
            )


def _read(message: TFMessage) -> dict[str, Transform]:
    result: dict[str, Transform] = {}
    for stamped in message.transforms:
        parent, child = frame_name(stamped.header.frame_id), frame_name(stamped.child_frame_id)
        move, turn = stamped.transform.translation, stamped.transform.rotation
        position, rotation = (move.x, move.y, move.z), (turn.x, turn.y, turn.z, turn.w)
        # As in tf2: refuse empty names, a frame as its own parent, NaN, and invalid quaternions.
        if (
            len({"", parent, child}) == 3
            and all(map(math.isfinite, (*position, *rotation)))
            and abs(math.hypot(*rotation) - 1.0) < 0.01
        ):
            result[child] = Transform(parent, RigidTransform(position, rotation))
    return result
