"""The ROS half of the differential drive: commands in, odometry and frames out."""

import logging
from math import cos, sin

import numpy as np
from geometry_msgs.msg import TransformStamped, TwistStamped
from nav_msgs.msg import Odometry
from rclpy.publisher import Publisher
from rclpy.qos import QoSPresetProfiles, QoSProfile
from rclpy.subscription import Subscription
from tf2_msgs.msg import TFMessage

from arm_control.diff_drive import (
    DiffDriveController,
    DiffDriveParameters,
    PlanarPose,
    PlanarTwist,
)
from arm_control.ros.controller_adapter import ControllerAdapter
from arm_control.throttle import Throttle
from arm_node.message_template import MessageTemplate

TF_DEPTH = 100
WARNING_INTERVAL_S = 1.0
POSE = [0, 1, 5, 6]
"""Of x y z and a quaternion x y z w: what a pose in the plane needs."""
TWIST = [0, 5]
"""Of the speeds along and about x y z: forwards and to the left."""


class DiffDriveAdapter(ControllerAdapter[DiffDriveController]):
    """Gives the controller ~/cmd_vel, ~/odom, ~/cmd_vel_out and its part of /tf."""

    _end_points: tuple[Publisher | Subscription, ...] = ()

    def on_configure(self, parameters: DiffDriveParameters) -> None:
        """Create the end points."""
        self._throttle = Throttle(WARNING_INTERVAL_S)
        qos = QoSPresetProfiles.SYSTEM_DEFAULT.value
        odometry = self.node.create_publisher(Odometry, "~/odom", qos)
        commands = frames = None
        if parameters.publish_limited_velocity:
            commands = self.node.create_publisher(TwistStamped, "~/cmd_vel_out", qos)
        if parameters.enable_odom_tf:
            # Not latched as the rest: a frame that is no longer published shall not come back.
            frames = self.node.create_publisher(TFMessage, "/tf", QoSProfile(depth=TF_DEPTH))
        self.controller.sink = DrivePublisher(
            parameters, self.node.get_namespace(), odometry, frames, commands
        )
        made = (publisher for publisher in (odometry, frames, commands) if publisher is not None)
        self._end_points = (
            *made,
            self.node.create_subscription(TwistStamped, "~/cmd_vel", self._take, qos),
        )

    def on_cleanup(self) -> None:
        """Destroy the end points."""
        self.controller.sink = None
        self.destroy(*self._end_points)
        self._end_points = ()

    def _take(self, message: TwistStamped) -> None:
        stamp = message.header.stamp
        stamp_s = stamp.sec + stamp.nanosec * 1e-9
        twist = PlanarTwist(message.twist.linear.x, message.twist.angular.z)
        reason = self.controller.offer(twist, stamp_s or None)
        if reason and self._throttle.permits():
            logging.getLogger(self.controller.name).warning("a command was dropped: %s", reason)


class DrivePublisher:
    """Publishes odometry, frames and limited commands; see `DriveSink`. Loop thread only."""

    def __init__(
        self,
        parameters: DiffDriveParameters,
        namespace: str,
        odometry: Publisher,
        frames: Publisher | None,
        commands: Publisher | None,
    ) -> None:
        odom = parameters.frame(parameters.odom_frame_id, namespace)
        base = parameters.frame(parameters.base_frame_id, namespace)
        self._odometry, self._frames, self._commands = odometry, frames, commands
        self._odometry_template = MessageTemplate(_odometry_message(parameters, odom, base))
        self._frame_template = MessageTemplate(TFMessage(transforms=[_frame_message(odom, base)]))
        command = TwistStamped()
        command.header.frame_id = base
        self._command_template = MessageTemplate(command)
        self._pose_at = self._odometry_template.indices("pose.pose")[POSE]
        self._twist_at = self._odometry_template.indices("twist.twist")[TWIST]
        self._frame_at = self._frame_template.indices("transforms[0].transform")[POSE]
        self._command_at = self._command_template.indices("twist")[TWIST]

    def publish_odometry(self, time_s: float, pose: PlanarPose, twist: PlanarTwist) -> None:
        """Publish where the robot is, as a message and as a frame."""
        stamp_ns = round(time_s * 1e9)
        numbers = (pose.x, pose.y, sin(pose.heading / 2), cos(pose.heading / 2))
        template = self._odometry_template
        template.set_stamps(stamp_ns)
        template.float64[self._pose_at] = numbers
        template.float64[self._twist_at] = (twist.linear, twist.angular)
        template.publish(self._odometry)
        if self._frames is not None:
            self._frame_template.set_stamps(stamp_ns)
            self._frame_template.float64[self._frame_at] = numbers
            self._frame_template.publish(self._frames)

    def publish_command(self, time_s: float, twist: PlanarTwist) -> None:
        """Publish the speeds within their limits."""
        if self._commands is not None:
            self._command_template.set_stamps(round(time_s * 1e9))
            self._command_template.float64[self._command_at] = (twist.linear, twist.angular)
            self._command_template.publish(self._commands)


def _odometry_message(parameters: DiffDriveParameters, odom: str, base: str) -> Odometry:
    message = Odometry(child_frame_id=base)
    message.header.frame_id = odom
    message.pose.covariance = np.diag(parameters.pose_covariance_diagonal).ravel()
    message.twist.covariance = np.diag(parameters.twist_covariance_diagonal).ravel()
    return message


def _frame_message(odom: str, base: str) -> TransformStamped:
    message = TransformStamped(child_frame_id=base)
    message.header.frame_id = odom
    return message
