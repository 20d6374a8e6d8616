"""The topics of one camera that measures distances: depth image and cloud of points."""

from array import array

import numpy as np
from numpy.typing import NDArray
from rclpy.node import Node
from sensor_msgs.msg import Image, PointCloud2, PointField

from arm_gazebo.camera.depth_image import CHANNELS, PointGrid
from arm_gazebo.ros.image_topic import QOS, set_stamp, watched
from arm_gazebo.sensors.camera import CameraSensor

FLOAT_BYTES = 4
POINT_FIELDS = ("x", "y", "z", "rgb")


class DepthPublisher:
    """Publishes 32FC1 images and organised clouds. One thread.

    Attributes:
        depth: the (height, width) floats of the image message.
    """

    def __init__(self, node: Node, sensor: CameraSensor) -> None:
        size = (sensor.height, sensor.width)
        self._image = _image_message(sensor)
        self._images = [node.create_publisher(Image, t, QOS) for t in sensor.depth_topics]
        self._cloud = _cloud_message(sensor)
        self._clouds = [node.create_publisher(PointCloud2, t, QOS) for t in sensor.points_topics]
        self.depth = np.frombuffer(self._image.data, np.float32).reshape(size)
        self._points = np.frombuffer(self._cloud.data, np.float32).reshape(*size, CHANNELS)
        self._grid = PointGrid(sensor)

    @property
    def subscribers(self) -> int:
        """How many subscribers there are."""
        return sum(p.get_subscription_count() for p in (*self._images, *self._clouds))

    def wants_colours(self) -> bool:
        """Return whether somebody subscribes to points, which have colours."""
        return bool(watched(self._clouds))

    def publish(self, time_s: float, picture: NDArray[np.uint8] | None) -> None:
        """Publish the distances where somebody subscribes to them.

        Args:
            time_s: stamp.
            picture: (height, width, 3) colours of the points, None for none.
        """
        set_stamp(self._image.header, time_s)
        for publisher in watched(self._images):
            publisher.publish(self._image)
        clouds = watched(self._clouds)
        if clouds:
            set_stamp(self._cloud.header, time_s)
            self._grid.fill(self._points, self.depth, picture)
            for publisher in clouds:
                publisher.publish(self._cloud)


def _image_message(sensor: CameraSensor) -> Image:
    message = Image(height=sensor.height, width=sensor.width, encoding="32FC1")
    message.header.frame_id = sensor.optical_frame
    message.step = sensor.width * FLOAT_BYTES
    message.data = array("B", bytes(message.step * sensor.height))
    return message


def _cloud_message(sensor: CameraSensor) -> PointCloud2:
    message = PointCloud2(height=sensor.height, width=sensor.width, is_dense=False)
    message.header.frame_id = sensor.optical_frame
    # Points without colour keep the room for it: one layout for all.
    names = POINT_FIELDS if sensor.image_topics else POINT_FIELDS[:3]
    message.fields = [
        PointField(name=name, offset=FLOAT_BYTES * index, datatype=PointField.FLOAT32, count=1)
        for index, name in enumerate(names)
    ]
    message.point_step = FLOAT_BYTES * CHANNELS
    message.row_step = message.point_step * sensor.width
    message.data = array("B", bytes(message.row_step * sensor.height))
    return message
