"""The ROS half of the differential drive: commands in, odometry and frames out."""

from geometry_msgs.msg import TwistStamped
from nav_msgs.msg import Odometry
from rclpy.publisher import Publisher
from rclpy.qos import QoSProfile
from tf2_msgs.msg import TFMessage

from arm_control.controllers.diff_drive.controller import DiffDriveController
from arm_control.controllers.diff_drive.odometry import PlanarPose, PlanarTwist
from arm_control.controllers.diff_drive.parameters import DiffDriveParameters
from arm_control.controllers.ros_adapter import ControllerAdapter, seconds_of
from arm_control.controllers.ros_odometry import OdometryPublisher
from arm_node.workarounds.message_template import MessageTemplate

TF_DEPTH = 100
TWIST = [0, 5]
"""Indices in the velocities along and about x y z: forward velocity and yaw rate."""


class DiffDriveAdapter(ControllerAdapter[DiffDriveController]):
    """Connects the controller to ~/cmd_vel, ~/odom, ~/cmd_vel_out and /tf."""

    def on_configure(self, parameters: DiffDriveParameters) -> None:
        """Create the end points."""
        odometry = self.publisher(Odometry, "~/odom")
        commands = frames = None
        if parameters.publish_limited_velocity:
            commands = self.publisher(TwistStamped, "~/cmd_vel_out")
        if parameters.enable_odom_tf:
            # Not latched like the others: a frame that is no longer published must not reappear.
            frames = self.publisher(TFMessage, "/tf", QoSProfile(depth=TF_DEPTH))
        self.controller.sink = _DrivePublisher(
            parameters, self.node.get_namespace(), odometry, frames, commands
        )
        self.subscribe(TwistStamped, "~/cmd_vel", self._take)

    def _take(self, message: TwistStamped) -> None:
        if not self.takes_commands("~/cmd_vel"):
            return
        twist = PlanarTwist(message.twist.linear.x, message.twist.angular.z)
        stamp_s = seconds_of(message.header.stamp)
        self.warn_dropped("command", self.controller.offer(twist, stamp_s or None))


class _DrivePublisher:
    """Publishes odometry, frames and limited commands; see `DriveSink`. Loop thread only."""

    def __init__(
        self,
        parameters: DiffDriveParameters,
        namespace: str,
        odometry: Publisher,
        frames: Publisher | None,
        commands: Publisher | None,
    ) -> None:
        base = parameters.frame(parameters.base_frame_id, namespace)
        self._odometry = OdometryPublisher(
            odometry,
            frames,
            parameters.frame(parameters.odom_frame_id, namespace),
            base,
            (parameters.pose_covariance_diagonal, parameters.twist_covariance_diagonal),
            TWIST,
        )
        self._commands = commands
        command = TwistStamped()
        command.header.frame_id = base
        self._command_template = MessageTemplate(command)
        self._command_at = self._command_template.indices("twist")[TWIST]

    def publish_odometry(self, time_s: float, pose: PlanarPose, twist: PlanarTwist) -> None:
        """Publish the pose as a message and as a frame."""
        self._odometry.publish(
            time_s, (pose.x, pose.y, pose.heading), (twist.linear, twist.angular)
        )

    def publish_command(self, time_s: float, twist: PlanarTwist) -> None:
        """Publish the limited twist."""
        if self._commands is not None:
            self._command_template.set_stamps(round(time_s * 1e9))
            self._command_template.float64[self._command_at] = (twist.linear, twist.angular)
            self._command_template.publish(self._commands)
