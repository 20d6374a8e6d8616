"""Publishes a controller manager's health on /diagnostics."""

import threading
from collections.abc import Callable

from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from rclpy.node import Node

from arm_control.manager.diagnostics import HealthReport, ManagerDiagnostics, waiting_reports
from arm_control.manager.settings import ManagerSettings

TOPIC = "/diagnostics"
HARDWARE_ID = "ros2_control"

SLICE_S = 1.0
"""A shorter period takes effect after at most this long."""


class HealthPublisher:
    """Publishes one DiagnosticArray per `diagnostic_updater.period` of wall time.

    It has its own thread, because diagnostics matter most when the control loop is stuck and the
    services wait for it. Until `watch` it reports that the manager waits for its description.
    """

    def __init__(
        self, node: Node, settings: Callable[[], ManagerSettings], stamp: Callable[[], Time]
    ) -> None:
        """Prepare the thread.

        Args:
            node: publishes the messages.
            settings: returns the manager's current parameters; any thread.
            stamp: returns the time for a message's header; any thread.
        """
        self._node = node
        self._settings = settings
        self._stamp = stamp
        self._diagnostics: ManagerDiagnostics | None = None
        self._stopping = threading.Event()
        self._thread = threading.Thread(target=self._run, name="diagnostics", daemon=True)

    def start(self) -> None:
        """Start publishing; the first message follows after one period, to keep the start quick."""
        self._thread.start()

    def watch(self, diagnostics: ManagerDiagnostics) -> None:
        """Report these diagnostics; any thread."""
        self._diagnostics = diagnostics

    def stop(self) -> None:
        """Stop publishing, and wait until the last message has been sent."""
        self._stopping.set()
        if self._thread.is_alive():
            self._thread.join()

    def _run(self) -> None:
        publisher = None
        while self._wait():
            publisher = publisher or self._node.create_publisher(DiagnosticArray, TOPIC, 1)
            publisher.publish(self._message())

    def _wait(self) -> bool:
        """Wait for one period; return False as soon as publishing must stop.

        It waits in slices, because the period may change meanwhile and may even be infinite.
        """
        waited_s = 0.0
        while (rest_s := self._settings().diagnostic_updater.period - waited_s) > 0.0:
            slice_s = min(rest_s, SLICE_S)
            if self._stopping.wait(slice_s):
                return False
            waited_s += slice_s
        return True

    def _message(self) -> DiagnosticArray:
        node, diagnostics = self._node, self._diagnostics
        settings = self._settings()
        reports = (
            waiting_reports()
            if diagnostics is None
            else diagnostics.reports(settings.diagnostics.threshold)
        )
        name = (
            node.get_fully_qualified_name()
            if settings.diagnostic_updater.use_fqn
            else node.get_name()
        )
        message = DiagnosticArray(status=[_status(name, report) for report in reports])
        message.header.stamp = self._stamp()
        return message


def _status(node_name: str, report: HealthReport) -> DiagnosticStatus:
    return DiagnosticStatus(
        level=bytes([report.level]),
        name=f"{node_name}: {report.task}",
        message=report.message,
        hardware_id=HARDWARE_ID,
        values=[KeyValue(key=key, value=value) for key, value in report.values.items()],
    )
