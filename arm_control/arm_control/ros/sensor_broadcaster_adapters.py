"""The ROS halves of the sensor broadcasters: ~/imu and ~/wrench."""

from typing import Any

from geometry_msgs.msg import WrenchStamped
from rclpy.publisher import Publisher
from rclpy.qos import QoSPresetProfiles
from sensor_msgs.msg import Imu

from arm_control.force_torque_sensor_broadcaster import ForceTorqueSensorBroadcasterParameters
from arm_control.imu_sensor_broadcaster import ImuSensorBroadcasterParameters
from arm_control.ros.controller_adapter import ControllerAdapter
from arm_control.ros.reading_publisher import ReadingPublisher
from arm_control.sensor_broadcaster import SensorBroadcaster

IMU_PATHS = ("orientation", "angular_velocity", "linear_acceleration")
WRENCH_PATHS = ("wrench.force", "wrench.torque")


class _SensorBroadcasterAdapter(ControllerAdapter[SensorBroadcaster[Any]]):
    """Gives a broadcaster its publisher."""

    _publishers: tuple[Publisher, ...] = ()

    def open(self, topic: str, message: Any, paths: tuple[str, ...]) -> None:
        """Publish readings on this topic, in messages like this one."""
        publisher = self.node.create_publisher(
            type(message), topic, QoSPresetProfiles.SYSTEM_DEFAULT.value
        )
        self._publishers = (publisher,)
        self.controller.sink = ReadingPublisher(publisher, message, paths)

    def on_cleanup(self) -> None:
        """Destroy the publisher."""
        self.controller.sink = None
        self.destroy(*self._publishers)
        self._publishers = ()


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
