"""Publishes a planar pose and twist as nav_msgs/msg/Odometry and as a transform."""

from collections.abc import Sequence
from math import cos, sin

import numpy as np
from geometry_msgs.msg import TransformStamped
from nav_msgs.msg import Odometry
from rclpy.publisher import Publisher
from tf2_msgs.msg import TFMessage

from arm_node.workarounds.message_template import MessageTemplate

POSE = [0, 1, 5, 6]
"""Indices in x y z and a quaternion x y z w that a planar pose uses."""


class OdometryPublisher:
    """Publishes where a robot is, and how fast it moves. Loop thread only.

    Args:
        odometry: publisher of nav_msgs/msg/Odometry.
        frames: publisher of tf2_msgs/msg/TFMessage; None publishes no transform.
        odom: the frame of the odometry.
        base: the frame of the robot.
        covariances: diagonals of the pose's and the twist's covariance, six numbers each.
        twist: indices of the published velocities along and about x y z.
    """

    def __init__(
        self,
        odometry: Publisher,
        frames: Publisher | None,
        odom: str,
        base: str,
        covariances: tuple[Sequence[float], Sequence[float]],
        twist: Sequence[int],
    ) -> None:
        message = Odometry(child_frame_id=base)
        message.header.frame_id = odom
        message.pose.covariance = np.diag(covariances[0]).ravel()
        message.twist.covariance = np.diag(covariances[1]).ravel()
        frame = TransformStamped(child_frame_id=base)
        frame.header.frame_id = odom
        self._odometry, self._frames = odometry, frames
        self._odometry_template = MessageTemplate(message)
        self._frame_template = MessageTemplate(TFMessage(transforms=[frame]))
        self._pose_at = self._odometry_template.indices("pose.pose")[POSE]
        self._twist_at = self._odometry_template.indices("twist.twist")[list(twist)]
        self._frame_at = self._frame_template.indices("transforms[0].transform")[POSE]

    def publish(
        self, time_s: float, pose: tuple[float, float, float], twist: Sequence[float]
    ) -> None:
        """Publish a pose, x and y in m and heading in rad, and the velocities of `twist`."""
        x, y, heading = pose
        stamp_ns = round(time_s * 1e9)
        numbers = (x, y, sin(heading / 2), cos(heading / 2))
        template = self._odometry_template
        template.set_stamps(stamp_ns)
        template.float64[self._pose_at] = numbers
        template.float64[self._twist_at] = twist
        template.publish(self._odometry)
        if self._frames is not None:
            self._frame_template.set_stamps(stamp_ns)
            self._frame_template.float64[self._frame_at] = numbers
            self._frame_template.publish(self._frames)
