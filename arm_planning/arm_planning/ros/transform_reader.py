"""Poses of frames on /tf."""

import threading

from builtin_interfaces.msg import Time
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.serialization import deserialize_message
from tf2_msgs.msg import TFMessage

from arm_node.polled_subscriptions import PolledSubscriptions
from arm_node.rigid_transform import RigidTransform
from arm_planning.ros.convert import NANOSECONDS
from arm_planning.scene.transform_history import TransformHistory

TRANSFORMS_TAKEN = 200


class TransformReader:
    """Reads /tf and /tf_static, only when somebody asks for a frame. Any thread."""

    def __init__(self, node: Node) -> None:
        """Subscribe."""
        self._polled = PolledSubscriptions(node)
        latched = QoSProfile(depth=TRANSFORMS_TAKEN, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self._static = self._polled.subscribe(TFMessage, "/tf_static", latched)
        self._moving = self._polled.subscribe(TFMessage, "/tf", QoSProfile(depth=TRANSFORMS_TAKEN))
        self._history = TransformHistory()
        self._lock = threading.Lock()

    def pose(self, name: str, base: str, stamp: Time | None = None) -> RigidTransform | None:
        """Return a frame's pose in another one; None if no transforms connect them.

        It is the one at a stamp, as far as the last transforms go back; without a stamp the last.
        """
        stamp_ns = None if stamp is None else stamp.sec * NANOSECONDS + stamp.nanosec
        with self._lock:
            for subscription in (self._static, self._moving):
                for raw, _ in self._polled.take(subscription, TRANSFORMS_TAKEN):
                    self._hear(deserialize_message(raw, TFMessage), subscription is self._static)
            return self._history.pose(name.lstrip("/"), base.lstrip("/"), stamp_ns)

    def _hear(self, message: TFMessage, is_static: bool) -> None:
        for stamped in message.transforms:
            translation, rotation = stamped.transform.translation, stamped.transform.rotation
            pose = RigidTransform(
                (translation.x, translation.y, translation.z),
                (rotation.x, rotation.y, rotation.z, rotation.w),
            )
            child, parent = (
                name.lstrip("/") for name in (stamped.child_frame_id, stamped.header.frame_id)
            )
            if is_static:
                self._history.add_static(child, parent, pose)
            else:
                stamp = stamped.header.stamp
                self._history.add(child, parent, pose, stamp.sec * NANOSECONDS + stamp.nanosec)
