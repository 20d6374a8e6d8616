"""The ROS halves of the sensor broadcasters: ~/imu and ~/wrench."""

from typing import Any

from geometry_msgs.msg import WrenchStamped
from sensor_msgs.msg import Imu

from arm_control.controllers.ros_adapter import ControllerAdapter, ReadingPublisher
from arm_control.controllers.sensor_broadcasters.controller import (
    ForceTorqueSensorBroadcasterParameters,
    ImuSensorBroadcasterParameters,
    SensorBroadcaster,
)

IMU_PATHS = ("orientation", "angular_velocity", "linear_acceleration")
WRENCH_PATHS = ("wrench.force", "wrench.torque")


class _SensorBroadcasterAdapter(ControllerAdapter[SensorBroadcaster[Any]]):
    """Gives a broadcaster its publisher."""

    def open(self, topic: str, message: Any, paths: tuple[str, ...]) -> None:
        """Publish readings on a topic; `message` provides the constant fields."""
        publisher = self.publisher(type(message), topic)
        self.controller.sink = ReadingPublisher(publisher, message, paths)


class ImuSensorBroadcasterAdapter(_SensorBroadcasterAdapter):
    """Publishes sensor_msgs/msg/Imu."""

    def on_configure(self, parameters: ImuSensorBroadcasterParameters) -> None:
        """Create the publisher."""
        message = Imu()
        message.header.frame_id = parameters.frame_id
        message.orientation_covariance = parameters.static_covariance_orientation
        message.angular_velocity_covariance = parameters.static_covariance_angular_velocity
        message.linear_acceleration_covariance = parameters.static_covariance_linear_acceleration
        self.open("~/imu", message, IMU_PATHS)


class ForceTorqueSensorBroadcasterAdapter(_SensorBroadcasterAdapter):
    """Publishes geometry_msgs/msg/WrenchStamped."""

    def on_configure(self, parameters: ForceTorqueSensorBroadcasterParameters) -> None:
        """Create the publisher."""
        message = WrenchStamped()
        message.header.frame_id = parameters.frame_id
        self.open("~/wrench", message, WRENCH_PATHS)
