"""Poses of frames on /tf."""

import threading

from geometry_msgs.msg import TransformStamped
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.serialization import deserialize_message
from tf2_msgs.msg import TFMessage

from arm_node.polled_subscriptions import PolledSubscriptions
from arm_node.rigid_transform import RigidTransform

TRANSFORMS_TAKEN = 200


class TransformReader:
    """Reads /tf and /tf_static, only when somebody asks for a frame. Any thread."""

    def __init__(self, node: Node) -> None:
        """Subscribe."""
        self._polled = PolledSubscriptions(node)
        latched = QoSProfile(depth=TRANSFORMS_TAKEN, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self._subscriptions = (
            self._polled.subscribe(TFMessage, "/tf_static", latched),
            self._polled.subscribe(TFMessage, "/tf", QoSProfile(depth=TRANSFORMS_TAKEN)),
        )
        self._latest: dict[str, TransformStamped] = {}
        self._lock = threading.Lock()

    def pose(self, name: str, base: str) -> RigidTransform | None:
        """Return a frame's pose in another one; None if no transforms connect them."""
        with self._lock:
            for subscription in self._subscriptions:
                for raw, _ in self._polled.take(subscription, TRANSFORMS_TAKEN):
                    message: TFMessage = deserialize_message(raw, TFMessage)
                    for transform in message.transforms:
                        self._latest[transform.child_frame_id.lstrip("/")] = transform
            ours = self._in_root(base.lstrip("/"))
            theirs = self._in_root(name.lstrip("/"))
        if ours[0] != theirs[0]:
            return None
        return ours[1].inverse().then(theirs[1])

    def _in_root(self, name: str) -> tuple[str, RigidTransform]:
        """Return the root above a frame, and the frame's pose in it."""
        pose, passed = RigidTransform(), {name}
        while name in self._latest:
            stamped = self._latest[name]
            translation, rotation = stamped.transform.translation, stamped.transform.rotation
            step = RigidTransform(
                (translation.x, translation.y, translation.z),
                (rotation.x, rotation.y, rotation.z, rotation.w),
            )
            pose, name = step.then(pose), stamped.header.frame_id.lstrip("/")
            if name in passed:
                break
            passed.add(name)
        return name, pose
