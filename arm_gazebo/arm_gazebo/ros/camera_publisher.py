"""A camera's topics: images, depth, point clouds and camera info; and its rate on /diagnostics."""

from array import array
from collections.abc import Sequence
from typing import Any

import numpy as np
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from numpy.typing import NDArray
from rclpy.node import Node
from rclpy.qos import QoSProfile
from sensor_msgs.msg import CameraInfo, CompressedImage, Image, PointCloud2, PointField

from arm_gazebo.camera.depth_image import CHANNELS, PointGrid
from arm_gazebo.camera.pipeline import CameraPipeline, CameraReport
from arm_gazebo.ros.topic import set_stamp
from arm_gazebo.sensors.camera import CameraSensor

QOS = QoSProfile(depth=2)
"""Reliable and volatile, so that both default and best-effort subscribers match."""
FLOAT_BYTES = 4
POINT_FIELDS = ("x", "y", "z", "rgb")
JPEG_QUALITY = 80


class _Topics:
    """One message, and the topics that it is published on."""

    def __init__(self, node: Node, message: Any, names: Sequence[str]) -> None:
        self.message = message
        self._publishers = [node.create_publisher(type(message), name, QOS) for name in names]

    @property
    def subscribers(self) -> int:
        """Number of subscribers now; takes about 1 us per topic."""
        return sum(publisher.get_subscription_count() for publisher in self._publishers)

    def publish(self, time_s: float) -> None:
        """Publish the message on the topics with subscribers, with a stamp."""
        set_stamp(self.message.header, time_s)
        for publisher in self._publishers:
            if publisher.get_subscription_count():
                publisher.publish(self.message)


class _DepthPublisher:
    """Publishes 32FC1 images and organised point clouds. One thread.

    Attributes:
        depth: the (height, width) floats of the image message.
    """

    def __init__(self, node: Node, sensor: CameraSensor) -> None:
        size = (sensor.height, sensor.width)
        image = _image_message(sensor, "32FC1", FLOAT_BYTES)
        self._images = _Topics(node, image, sensor.depth_topics)
        cloud = _cloud_message(sensor)
        self._clouds = _Topics(node, cloud, sensor.points_topics)
        self.depth = np.frombuffer(image.data, np.float32).reshape(size)
        self._points = np.frombuffer(cloud.data, np.float32).reshape(*size, CHANNELS)
        self._grid = PointGrid(sensor)

    @property
    def subscribers(self) -> int:
        """Number of subscribers."""
        return self._images.subscribers + self._clouds.subscribers

    def wants_colours(self) -> bool:
        """Return whether the point cloud, which has colours, has subscribers."""
        return self._clouds.subscribers > 0

    def publish(self, time_s: float, picture: NDArray[np.uint8] | None) -> None:
        """Publish the depth on topics with subscribers, with colours (height, width, 3) if any."""
        self._images.publish(time_s)
        if self._clouds.subscribers:
            self._grid.fill(self._points, self.depth, picture)
            self._clouds.publish(time_s)


def _image_message(sensor: CameraSensor, encoding: str, pixel_bytes: int) -> Image:
    message = Image(height=sensor.height, width=sensor.width, encoding=encoding)
    message.header.frame_id = sensor.optical_frame
    message.step = sensor.width * pixel_bytes
    message.data = array("B", bytes(message.step * sensor.height))
    return message


def _cloud_message(sensor: CameraSensor) -> PointCloud2:
    message = PointCloud2(height=sensor.height, width=sensor.width, is_dense=False)
    message.header.frame_id = sensor.optical_frame
    # Points without colour keep its bytes, so that all clouds have one layout.
    names = POINT_FIELDS if sensor.image_topics else POINT_FIELDS[:3]
    message.fields = [
        PointField(name=name, offset=FLOAT_BYTES * index, datatype=PointField.FLOAT32, count=1)
        for index, name in enumerate(names)
    ]
    message.point_step = FLOAT_BYTES * CHANNELS
    message.row_step = message.point_step * sensor.width
    message.data = array("B", bytes(message.row_step * sensor.height))
    return message


class CameraPublisher:
    """Publishes one camera; a `FrameSink`. One thread.

    Messages are created once, and images are rendered directly into the bytes of the message.
    Assigning a new array to `data` for each image would cost a thousand times as much.

    Attributes:
        picture: the (height, width, 3) bytes of the image message.
    """

    def __init__(self, node: Node, sensor: CameraSensor) -> None:
        image = _image_message(sensor, "rgb8", 3)
        jpeg = CompressedImage(format="rgb8; jpeg compressed bgr8")
        jpeg.header.frame_id = sensor.optical_frame
        self._infos = _Topics(node, info_message(sensor), sensor.info_topics)
        self._images = _Topics(node, image, sensor.image_topics)
        self._jpegs = _Topics(node, jpeg, [f"{topic}/compressed" for topic in sensor.image_topics])
        self.picture = np.frombuffer(image.data, np.uint8).reshape(sensor.height, sensor.width, 3)
        self._colours = self.picture if sensor.image_topics else None
        self._depth = _DepthPublisher(node, sensor) if sensor.measures_depth else None

    @property
    def depth(self) -> NDArray[np.float32] | None:
        """The (height, width) floats of the depth message; None without one."""
        return None if self._depth is None else self._depth.depth

    @property
    def subscribers(self) -> int:
        """Number of subscribers to images, compressed images, depth and points."""
        pictures = self._images.subscribers + self._jpegs.subscribers
        return pictures + (0 if self._depth is None else self._depth.subscribers)

    def wants_picture(self) -> bool:
        """Return whether the colours have subscribers now; takes about 1 us per topic."""
        if self._images.subscribers or self._jpegs.subscribers:
            return True
        return self._colours is not None and self._depth is not None and self._depth.wants_colours()

    def wants_depth(self) -> bool:
        """Return whether the depth has subscribers now; takes about 1 us per topic."""
        return self._depth is not None and self._depth.subscribers > 0

    def publish_info(self, time_s: float) -> None:
        """Publish the camera info on every info topic with subscribers."""
        self._infos.publish(time_s)

    def publish_picture(self, time_s: float) -> None:
        """Publish the image, raw and compressed, on the topics that have subscribers."""
        self._images.publish(time_s)
        if self._jpegs.subscribers:
            self._jpegs.message.data = _compress(self.picture)
            self._jpegs.publish(time_s)

    def publish_depth(self, time_s: float) -> None:
        """Publish the depth image and the point cloud."""
        if self._depth is not None:
            self._depth.publish(time_s, self._colours)


def info_message(sensor: CameraSensor) -> CameraInfo:
    """Return the projection of a camera, in pixels.

    A point (x, y, z) in the optical frame appears at u = fx x / z + cx, v = fy y / z + cy, moved by
    the distortion. The image's upper left corner is (0, 0), and the centre of the first pixel is
    (0.5, 0.5), as in Gazebo; OpenCV and image_geometry put it at (0, 0), so for them cx and cy are
    half a pixel less.
    """
    lens = sensor.lens
    message = CameraInfo(height=sensor.height, width=sensor.width, distortion_model="plumb_bob")
    message.header.frame_id = sensor.optical_frame
    message.d = list(lens.distortion)
    message.k = lens.matrix.ravel()
    message.r = np.eye(3).ravel()
    # Of the rectified image.
    message.p = np.column_stack([lens.matrix, np.zeros(3)]).ravel()
    return message


def _compress(picture: NDArray[np.uint8]) -> "array[int]":
    # Imported only when needed, because it costs 0.1 s and 40 MB.
    import cv2

    swapped = cv2.cvtColor(picture, cv2.COLOR_RGB2BGR)
    _ok, encoded = cv2.imencode(".jpg", swapped, [cv2.IMWRITE_JPEG_QUALITY, JPEG_QUALITY])
    return array("B", encoded.tobytes())


PERIOD_S = 1.0
MIN_ACHIEVED = 0.9


class CameraDiagnostics:
    """Publishes one DiagnosticArray per second, with one status per camera."""

    def __init__(
        self,
        node: Node,
        sensors: Sequence[CameraSensor],
        publishers: Sequence[CameraPublisher],
        pipeline: CameraPipeline,
    ) -> None:
        """Start reporting."""
        self._pipeline = pipeline
        self._cameras = tuple(zip(sensors, publishers, pipeline.statistics, strict=True))
        self._publisher = node.create_publisher(DiagnosticArray, "/diagnostics", 10)
        node.create_timer(PERIOD_S, self._publish)

    def _publish(self) -> None:
        message = DiagnosticArray()
        set_stamp(message.header, self._pipeline.time_s)
        message.status = [
            _status(sensor, publisher.subscribers, statistics.report(), self._pipeline.backend)
            for sensor, publisher, statistics in self._cameras
        ]
        self._publisher.publish(message)


def _status(
    sensor: CameraSensor, subscribers: int, report: CameraReport, backend: str
) -> DiagnosticStatus:
    achieved = report.achieved
    slow = achieved is not None and achieved < MIN_ACHIEVED
    if achieved is None:
        text = "no subscribers"
    else:
        text = f"{achieved * sensor.rate_hz:.1f} of {sensor.rate_hz:g} Hz"
    values = {
        "nominal rate (Hz of simulation time)": f"{sensor.rate_hz:g}",
        "achieved rate (Hz of simulation time)": (
            "0.0" if achieved is None else f"{achieved * sensor.rate_hz:.1f}"
        ),
        "frames rendered": str(report.rendered),
        "frames dropped": str(report.dropped),
        "render time (ms)": "-" if report.render_s is None else f"{report.render_s * 1e3:.1f}",
        "backend": backend,
        "subscribers": str(subscribers),
        "size": f"{sensor.width}x{sensor.height}",
    }
    return DiagnosticStatus(
        level=DiagnosticStatus.WARN if slow else DiagnosticStatus.OK,
        name=f"camera: {sensor.name}",
        message=text,
        hardware_id=sensor.name,
        values=[KeyValue(key=key, value=value) for key, value in values.items()],
    )
