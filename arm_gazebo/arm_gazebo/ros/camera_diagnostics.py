"""Report each camera's achieved rate on /diagnostics."""

from collections.abc import Sequence

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from rclpy.node import Node

from arm_gazebo.camera.pipeline import CameraPipeline
from arm_gazebo.camera.statistics import CameraReport
from arm_gazebo.ros.camera_publisher import CameraPublisher, set_stamp
from arm_gazebo.sensors.camera import CameraSensor

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
        """Start reporting.

        Args:
            node: the node that gets the publisher and a timer.
            sensors: the cameras.
            publishers: the publisher of each camera.
            pipeline: renders the cameras.
        """
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
