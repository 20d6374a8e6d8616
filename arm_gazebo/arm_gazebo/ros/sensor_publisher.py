"""The topics of IMUs, force-torque and contact sensors."""

import numpy as np
from geometry_msgs.msg import WrenchStamped
from numpy.typing import NDArray
from rclpy.node import Node
from rclpy.qos import QoSProfile
from sensor_msgs.msg import Imu
from std_msgs.msg import Bool

from arm_control.ros.reading_publisher import ReadingPublisher
from arm_control.sensor_broadcaster import ReadingSink
from arm_gazebo.sensors.contact import ContactSensor
from arm_gazebo.sensors.imu import ImuSensor
from arm_gazebo.sensors.link_sensor import LinkSensor
from arm_gazebo.sensors.noise import NoiseModel

QOS = QoSProfile(depth=10)
"""Reliable and volatile: default and best-effort subscribers both match."""
WRENCH = ("wrench.force", "wrench.torque")
UNKNOWN = -1.0
"""First number of the covariance of what a message does not tell."""


class ContactPublisher:
    """Publishes whether a link is touched, and the force of that; see `ReadingSink`."""

    def __init__(self, node: Node, sensor: ContactSensor) -> None:
        self._wrench = _wrench_publisher(node, sensor, first=1)
        self._state = node.create_publisher(Bool, f"{sensor.topic}/in_contact", QOS)

    def wanted(self) -> bool:
        """Return whether anybody subscribes to either."""
        return self._wrench.wanted() or self._state.get_subscription_count() > 0

    def publish(self, time_s: float, reading: NDArray[np.float64]) -> None:
        """Publish a reading."""
        self._state.publish(Bool(data=bool(reading[0])))
        self._wrench.publish(time_s, reading)


def sensor_publisher(node: Node, sensor: LinkSensor) -> ReadingSink:
    """Return what publishes the readings of a sensor as ROS's message for it."""
    if isinstance(sensor, ImuSensor):
        return _imu_publisher(node, sensor)
    if isinstance(sensor, ContactSensor):
        return ContactPublisher(node, sensor)
    return _wrench_publisher(node, sensor)


def _imu_publisher(node: Node, sensor: ImuSensor) -> ReadingPublisher:
    message = Imu()
    message.header.frame_id = sensor.frame_id
    message.angular_velocity_covariance = _covariance(sensor.angular_velocity_noise)
    message.linear_acceleration_covariance = _covariance(sensor.linear_acceleration_noise)
    paths = ["orientation", "angular_velocity", "linear_acceleration"]
    if not sensor.has_orientation:
        message.orientation_covariance[0] = UNKNOWN
        del paths[0]
    publisher = node.create_publisher(Imu, sensor.topic, QOS)
    return ReadingPublisher(publisher, message, paths, first=0 if sensor.has_orientation else 4)


def _wrench_publisher(node: Node, sensor: LinkSensor, first: int = 0) -> ReadingPublisher:
    message = WrenchStamped()
    message.header.frame_id = sensor.frame_id
    publisher = node.create_publisher(WrenchStamped, sensor.topic, QOS)
    return ReadingPublisher(publisher, message, WRENCH, first)


def _covariance(noise: tuple[NoiseModel, ...]) -> NDArray[np.float64]:
    return np.diag([model.stddev**2 for model in noise]).ravel()
