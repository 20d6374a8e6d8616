"""One camera's topics: pictures, compressed pictures, distances and intrinsics."""

from array import array

import numpy as np
from numpy.typing import NDArray
from rclpy.node import Node
from sensor_msgs.msg import CameraInfo, CompressedImage, Image

from arm_gazebo.camera.info import DISTORTION_MODEL, Intrinsics
from arm_gazebo.ros.depth_publisher import DepthPublisher
from arm_gazebo.ros.image_topic import QOS, set_stamp, watched
from arm_gazebo.sensors.camera import CameraSensor

JPEG_QUALITY = 80


class CameraPublisher:
    """Publishes one camera; a `FrameSink`. One thread.

    Messages are made once. Pictures are drawn straight into the bytes of the message: setting
    `data` to a new array for each would cost a thousand times as much.
    """

    def __init__(self, node: Node, sensor: CameraSensor) -> None:
        self._info = _info_message(sensor)
        self._infos = [node.create_publisher(CameraInfo, t, QOS) for t in sensor.info_topics]
        self._image = _image_message(sensor)
        self._images = [node.create_publisher(Image, t, QOS) for t in sensor.image_topics]
        self._jpeg = CompressedImage(format="rgb8; jpeg compressed bgr8")
        self._jpeg.header.frame_id = sensor.optical_frame
        self._jpegs = [
            node.create_publisher(CompressedImage, f"{t}/compressed", QOS)
            for t in sensor.image_topics
        ]
        self._picture = np.frombuffer(self._image.data, np.uint8).reshape(
            sensor.height, sensor.width, 3
        )
        self._colours = self._picture if sensor.image_topics else None
        self._depth = DepthPublisher(node, sensor) if sensor.measures_depth else None

    @property
    def picture(self) -> NDArray[np.uint8]:
        """The (height, width, 3) bytes of the image message."""
        return self._picture

    @property
    def depth(self) -> NDArray[np.float32] | None:
        """The (height, width) floats of the depth message; None without one."""
        return None if self._depth is None else self._depth.depth

    @property
    def subscribers(self) -> int:
        """How many subscribers pictures and distances have, compressed pictures included."""
        pictures = sum(p.get_subscription_count() for p in (*self._images, *self._jpegs))
        return pictures + (0 if self._depth is None else self._depth.subscribers)

    def wants_picture(self) -> bool:
        """Return whether anybody looks at the colours now; about 1 us a topic."""
        if watched((*self._images, *self._jpegs)):
            return True
        return self._colours is not None and self._depth is not None and self._depth.wants_colours()

    def wants_depth(self) -> bool:
        """Return whether anybody subscribes to the distances now; about 1 us a topic."""
        return self._depth is not None and self._depth.subscribers > 0

    def publish_info(self, time_s: float) -> None:
        """Publish the intrinsics on every info topic."""
        set_stamp(self._info.header, time_s)
        for publisher in self._infos:
            publisher.publish(self._info)

    def publish_picture(self, time_s: float) -> None:
        """Publish the picture where somebody subscribes to it, compressed or not."""
        set_stamp(self._image.header, time_s)
        for publisher in watched(self._images):
            publisher.publish(self._image)
        jpegs = watched(self._jpegs)
        if jpegs:
            set_stamp(self._jpeg.header, time_s)
            self._jpeg.data = _compress(self._picture)
            for publisher in jpegs:
                publisher.publish(self._jpeg)

    def publish_depth(self, time_s: float) -> None:
        """Publish the distances, and the points that they and the picture make."""
        if self._depth is not None:
            self._depth.publish(time_s, self._colours)


def _image_message(sensor: CameraSensor) -> Image:
    message = Image(height=sensor.height, width=sensor.width, encoding="rgb8")
    message.header.frame_id = sensor.optical_frame
    message.step = sensor.width * 3
    message.data = array("B", bytes(message.step * sensor.height))
    return message


def _info_message(sensor: CameraSensor) -> CameraInfo:
    intrinsics = Intrinsics.of(sensor)
    message = CameraInfo(height=sensor.height, width=sensor.width)
    message.header.frame_id = sensor.optical_frame
    message.distortion_model = DISTORTION_MODEL
    message.d = list(intrinsics.d)
    message.k = np.array(intrinsics.k)
    message.r = np.array(intrinsics.r)
    message.p = np.array(intrinsics.p)
    return message


def _compress(picture: NDArray[np.uint8]) -> "array[int]":
    # Loaded only where somebody asks for it: it costs 0.1 s and 40 MB.
    import cv2

    swapped = cv2.cvtColor(picture, cv2.COLOR_RGB2BGR)
    _ok, encoded = cv2.imencode(".jpg", swapped, [cv2.IMWRITE_JPEG_QUALITY, JPEG_QUALITY])
    return array("B", encoded.tobytes())
