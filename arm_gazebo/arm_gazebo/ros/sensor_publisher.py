"""Publishes the readings of sensors on the topics that each sensor names."""

from typing import Any

import numpy as np
from numpy.typing import NDArray
from rclpy.node import Node
from rclpy.qos import QoSProfile

from arm_control.controllers.ros_adapter import ReadingPublisher
from arm_control.controllers.sensor_broadcasters.readings import ReadingSink
from arm_gazebo.ros.topic import message_class
from arm_gazebo.sensors.link_sensor import LinkSensor, SensorTopic

QOS = QoSProfile(depth=10)
"""Reliable and volatile: default and best-effort subscribers both match."""


class SensorPublisher:
    """Publishes the readings of one sensor on all its topics; see `ReadingSink`."""

    def __init__(self, node: Node, sensor: LinkSensor) -> None:
        self._topics = tuple(_topic_publisher(node, sensor, topic) for topic in sensor.topics())

    def wanted(self) -> bool:
        """Return whether anybody subscribes to one of the topics."""
        return any(topic.wanted() for topic in self._topics)

    def publish(self, time_s: float, reading: NDArray[np.float64]) -> None:
        """Publish a reading."""
        for topic in self._topics:
            topic.publish(time_s, reading)


class _ValuePublisher:
    """Publishes one value of a reading in a message without a header, such as std_msgs/msg/Bool."""

    def __init__(self, node: Node, topic: str, message: Any, described: SensorTopic) -> None:
        (self._field,) = described.fields
        self._index = described.first
        self._message = message
        self._type = type(getattr(message, self._field))
        self._publisher = node.create_publisher(type(message), topic, QOS)

    def wanted(self) -> bool:
        """Return whether there is a subscriber now."""
        return self._publisher.get_subscription_count() > 0

    def publish(self, time_s: float, reading: NDArray[np.float64]) -> None:
        """Publish the value of a reading."""
        setattr(self._message, self._field, self._type(reading[self._index]))
        self._publisher.publish(self._message)


def _topic_publisher(node: Node, sensor: LinkSensor, described: SensorTopic) -> ReadingSink:
    topic = f"{sensor.topic}{described.suffix}"
    message = message_class(described.message)()
    if not hasattr(message, "header"):
        return _ValuePublisher(node, topic, message, described)
    message.header.frame_id = sensor.frame_id
    for name, values in described.constants.items():
        setattr(message, name, values)
    publisher = node.create_publisher(type(message), topic, QOS)
    return ReadingPublisher(publisher, message, described.fields, described.first)
