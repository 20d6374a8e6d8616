"""Publishes a controller manager's health on /diagnostics."""

import threading
from typing import TYPE_CHECKING

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue

from arm_control.health_report import HealthReport
from arm_control.manager_diagnostics import ManagerDiagnostics, waiting_reports

if TYPE_CHECKING:
    from arm_control.ros.controller_manager_node import ControllerManagerNode

TOPIC = "/diagnostics"
HARDWARE_ID = "ros2_control"

SLICE_S = 1.0
"""A period that is set shorter counts after this long at most."""


class HealthPublisher:
    """Publishes one DiagnosticArray per `diagnostic_updater.period` of wall time.

    On a thread of its own: what it has to say is wanted most when the control loop is stuck and
    the services wait for it. Until `watch` the manager waits for its robot description.
    """

    def __init__(self, node: "ControllerManagerNode") -> None:
        self._node = node
        self._diagnostics: ManagerDiagnostics | None = None
        self._stopping = threading.Event()
        self._thread = threading.Thread(target=self._run, name="diagnostics", daemon=True)

    def start(self) -> None:
        """Publish from now on, the first time after one period: a start has other things to do."""
        self._thread.start()

    def watch(self, diagnostics: ManagerDiagnostics) -> None:
        """Report what these have to say; any thread."""
        self._diagnostics = diagnostics

    def stop(self) -> None:
        """Publish no more, and wait until the last report is out."""
        self._stopping.set()
        if self._thread.is_alive():
            self._thread.join()

    def _run(self) -> None:
        publisher = None
        while self._wait():
            publisher = publisher or self._node.create_publisher(DiagnosticArray, TOPIC, 1)
            publisher.publish(self._message())

    def _wait(self) -> bool:
        """Let one period pass; return False as soon as there is nothing to publish any more.

        In slices: the period may change meanwhile, and may be too long for a wait, infinite even.
        """
        waited_s = 0.0
        while (rest_s := self._node.settings.diagnostic_updater.period - waited_s) > 0.0:
            slice_s = min(rest_s, SLICE_S)
            if self._stopping.wait(slice_s):
                return False
            waited_s += slice_s
        return True

    def _message(self) -> DiagnosticArray:
        node, diagnostics = self._node, self._diagnostics
        settings = node.settings
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
        message.header.stamp = node.stamp()
        return message


def _status(node_name: str, report: HealthReport) -> DiagnosticStatus:
    return DiagnosticStatus(
        level=bytes([report.level]),
        name=f"{node_name}: {report.task}",
        message=report.message,
        hardware_id=HARDWARE_ID,
        values=[KeyValue(key=key, value=value) for key, value in report.values.items()],
    )
