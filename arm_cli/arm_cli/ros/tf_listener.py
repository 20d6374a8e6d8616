"""Listens to /tf and /tf_static."""

from typing import Any

from rclpy.qos import DurabilityPolicy, QoSProfile
from tf2_msgs.msg import TFMessage

from arm_cli.frames.frame_log import FrameLog
from arm_cli.frames.pose import Pose
from arm_cli.ros.session import Session


class TfListener:
    """Puts all transforms into a log.

    Attributes:
        log: what has been heard.
    """

    def __init__(self, session: Session) -> None:
        """Subscribe with the session's node."""
        self.log = FrameLog()
        latched = QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        node = session.node
        node.create_subscription(TFMessage, "/tf", lambda m: self._take(m, False), 100)
        node.create_subscription(TFMessage, "/tf_static", lambda m: self._take(m, True), latched)

    def _take(self, message: Any, static: bool) -> None:
        for transform in message.transforms:
            stamp, move = transform.header.stamp, transform.transform
            turn = move.rotation
            self.log.add(
                transform.header.frame_id,
                transform.child_frame_id,
                stamp.sec + stamp.nanosec * 1e-9,
                Pose(
                    (move.translation.x, move.translation.y, move.translation.z),
                    (turn.x, turn.y, turn.z, turn.w),
                ),
                static,
            )
