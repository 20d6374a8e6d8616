"""Publishes transforms between fixed frames, cheaply: only stamps and numbers are rewritten."""

from collections.abc import Sequence

import numpy as np
from geometry_msgs.msg import TransformStamped
from numpy.typing import NDArray
from rclpy.publisher import Publisher
from tf2_msgs.msg import TFMessage

from arm_description.transform_tree import Frame
from arm_node.message_template import MessageTemplate


class TransformPublisher:
    """One TFMessage whose frames stay the same. One thread at a time."""

    def __init__(self, publisher: Publisher, frames: Sequence[Frame], prefix: str) -> None:
        """Lay the message out.

        Args:
            publisher: publishes TFMessage.
            frames: child frames in their parents.
            prefix: put before every frame's name as it stands.
        """
        self._publisher = publisher
        self._template = MessageTemplate(
            TFMessage(transforms=[_transform_stamped(frame, prefix) for frame in frames])
        )
        self._where = self._template.indices("transforms[*].transform")

    def publish(self, transforms: NDArray[np.float64], stamp_ns: int) -> None:
        """Publish (m, 7): x, y, z in m and the quaternion x, y, z, w of every frame."""
        self._template.set_stamps(stamp_ns)
        self._template.float64[self._where] = transforms.ravel()
        self._template.publish(self._publisher)


def _transform_stamped(frame: Frame, prefix: str) -> TransformStamped:
    message = TransformStamped()
    message.header.frame_id = prefix + frame.parent
    message.child_frame_id = prefix + frame.child
    return message
