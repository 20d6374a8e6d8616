"""The simulation's figures: the topic ~/statistics, and the service ~/get_statistics."""

from collections.abc import Callable, Sequence
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from diagnostic_msgs.srv import SelfTest
from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.node import Node

from arm_gazebo.physics.statistics import SimulationStatistics, StatusReport
from arm_gazebo.ros.topic import set_stamp
from arm_gazebo.world.editor import LoopCall
from arm_gazebo.world.refusal import RequestError

PERIOD_S = 1.0
DEPTH = 10
PASSED = b"\x01"


class StatisticsPublisher:
    """Publishes the figures once per second of wall time while somebody subscribes.

    Args:
        node: gets the publisher and the service; its executor may be blocked.
        statistics: the figures, which belong to the loop thread.
        now_s: returns the simulation time; loop thread.
        on_loop: runs a function on the loop thread and returns its result.
    """

    def __init__(
        self,
        node: Node,
        statistics: SimulationStatistics,
        now_s: Callable[[], float],
        on_loop: LoopCall,
    ) -> None:
        self._node = node
        self._statistics = statistics
        self._now_s = now_s
        self._on_loop = on_loop
        self._publisher = node.create_publisher(DiagnosticArray, "~/statistics", DEPTH)
        node.create_timer(PERIOD_S, self._publish, clock=Clock(clock_type=ClockType.STEADY_TIME))
        node.create_service(SelfTest, "~/get_statistics", self._answer)

    def _publish(self) -> None:
        is_wanted = self._publisher.get_subscription_count() > 0
        try:
            time_s, reports = self._on_loop(lambda: self._next_window(is_wanted))
        except RequestError:
            return  # A loop that is stuck is reported on /diagnostics.
        if is_wanted:
            message = DiagnosticArray(status=self._statuses(reports))
            set_stamp(message.header, time_s)
            self._publisher.publish(message)

    def _answer(self, _request: SelfTest.Request, response: SelfTest.Response) -> Any:
        response.id = self._node.get_fully_qualified_name()
        try:
            response.status = self._statuses(self._on_loop(self._statistics.report))
            response.passed = PASSED
        except RequestError as error:
            response.status = [
                DiagnosticStatus(level=DiagnosticStatus.ERROR, name="time", message=str(error))
            ]
        return response

    def _next_window(self, is_wanted: bool) -> tuple[float, Sequence[StatusReport]]:
        reports = self._statistics.report() if is_wanted else ()
        self._statistics.sample()
        return self._now_s(), reports

    def _statuses(self, reports: Sequence[StatusReport]) -> list[DiagnosticStatus]:
        return [
            DiagnosticStatus(
                level=DiagnosticStatus.OK,
                name=report.name,
                message=report.message,
                hardware_id=self._node.get_fully_qualified_name(),
                values=[KeyValue(key=key, value=value) for key, value in report.values.items()],
            )
            for report in reports
        ]
