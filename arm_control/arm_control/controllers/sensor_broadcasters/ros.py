"""The ROS halves of the sensor broadcasters: ~/imu and ~/wrench."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from geometry_msgs.msg import WrenchStamped
from numpy.typing import NDArray
from rclpy.publisher import Publisher
from sensor_msgs.msg import Imu

from arm_control.controllers.ros_adapter import ControllerAdapter
from arm_control.controllers.sensor_broadcasters.controller import (
    ForceTorqueSensorBroadcasterParameters,
    ImuSensorBroadcasterParameters,
    SensorBroadcaster,
)
from arm_node.workarounds.message_template import MessageTemplate


class ReadingPublisher:
    """Writes readings into one serialised message. Loop thread only.

    Args:
        publisher: a publisher of the message's type.
        message: a message with its final frame and covariances.
        paths: the fields that receive the numbers of a reading, in order.
        first: how many numbers at the start of a reading are not part of the message.
    """

    def __init__(
        self, publisher: Publisher, message: Any, paths: Sequence[str], first: int = 0
    ) -> None:
        self._publisher = publisher
        self._template = MessageTemplate(message)
        self._where = np.concatenate([self._template.indices(path) for path in paths])
        self._shown = slice(first, first + len(self._where))

    def wanted(self) -> bool:
        """Return whether there is a subscriber now; takes about 1 us."""
        return self._publisher.get_subscription_count() > 0

    def publish(self, time_s: float, reading: NDArray[np.float64]) -> None:
        """Publish a reading, shape (n,), stamped with the time of its state."""
        self._template.set_stamps(round(time_s * 1e9))
        self._template.float64[self._where] = reading[self._shown]
        self._template.publish(self._publisher)


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
