"""The ROS half of the mecanum drive: references in; odometry, transform and state out."""

import numpy as np
from control_msgs.msg import MecanumDriveControllerState
from geometry_msgs.msg import TwistStamped
from nav_msgs.msg import Odometry
from rclpy.publisher import Publisher
from tf2_msgs.msg import TFMessage

from arm_control.controllers.mecanum_drive.controller import (
    MecanumDriveController,
    MecanumDriveParameters,
)
from arm_control.controllers.mecanum_drive.kinematics import Array, MecanumOdometry, MecanumTwist
from arm_control.controllers.ros_adapter import ControllerAdapter, seconds_of
from arm_control.controllers.ros_odometry import OdometryPublisher
from arm_node.qos import NEWEST
from arm_node.workarounds.message_template import MessageTemplate

TWIST = (0, 1, 5)
"""Indices in the velocities along and about x y z that a mecanum drive has."""


class MecanumDriveAdapter(ControllerAdapter[MecanumDriveController]):
    """Connects the controller to ~/reference, ~/odometry, ~/tf_odometry and ~/controller_state."""

    def on_configure(self, parameters: MecanumDriveParameters) -> None:
        """Create the end points."""
        odometry = self.publisher(Odometry, "~/odometry")
        frames = self.publisher(TFMessage, "~/tf_odometry")
        state = self.publisher(MecanumDriveControllerState, "~/controller_state")
        publisher = OdometryPublisher(
            odometry,
            frames if parameters.enable_odom_tf else None,
            parameters.odom_frame_id,
            parameters.base_frame_id,
            (parameters.pose_covariance_diagonal, parameters.twist_covariance_diagonal),
            TWIST,
        )
        self.controller.sink = _MecanumPublisher(publisher, state, parameters.odom_frame_id)
        self.subscribe(TwistStamped, "~/reference", self._take_reference, NEWEST)

    def _take_reference(self, message: TwistStamped) -> None:
        if not self.takes_commands("~/reference"):
            return
        stamp_s, twist = seconds_of(message.header.stamp), message.twist
        reference = MecanumTwist(twist.linear.x, twist.linear.y, twist.angular.z)
        self.warn_dropped("reference", self.controller.offer(reference, stamp_s or None))


class _MecanumPublisher:
    """Publishes odometry and state; see `MecanumSink`. Loop thread only."""

    def __init__(self, odometry: OdometryPublisher, state: Publisher, odom: str) -> None:
        message = MecanumDriveControllerState()
        message.header.frame_id = odom
        self._odometry, self._state = odometry, state
        self._template = MessageTemplate(message)
        wheels = ("front_left", "front_right", "back_right", "back_left")
        self._wheels_at = np.concatenate(
            [self._template.indices(f"{wheel}_wheel_velocity") for wheel in wheels]
        )
        self._reference_at = self._template.indices("reference_velocity")[list(TWIST)]

    def publish(
        self, time_s: float, odometry: MecanumOdometry, wheels: Array, reference: MecanumTwist
    ) -> None:
        """Publish one cycle."""
        twist = odometry.twist
        self._odometry.publish(
            time_s, (odometry.x, odometry.y, odometry.heading), (twist.x, twist.y, twist.yaw)
        )
        template = self._template
        template.set_stamps(round(time_s * 1e9))
        template.float64[self._wheels_at] = wheels
        template.float64[self._reference_at] = (reference.x, reference.y, reference.yaw)
        template.publish(self._state)
