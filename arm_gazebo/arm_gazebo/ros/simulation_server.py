"""The node that serves simulation_interfaces, with the figures that it publishes."""

from collections.abc import Callable, Sequence
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from diagnostic_msgs.srv import SelfTest
from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node

from arm_control.loop.control_loop import ControlLoop
from arm_gazebo.camera.feed import CameraFeed
from arm_gazebo.errors import RequestError
from arm_gazebo.physics.statistics import SimulationStatistics, StatusReport
from arm_gazebo.physics_timing import PhysicsTiming
from arm_gazebo.ros.contact_markers import ContactMarkerPublisher
from arm_gazebo.ros.entity_services import EntityServices
from arm_gazebo.ros.run_services import RunServices, SnapshotServices, StepServices
from arm_gazebo.ros.topic import set_stamp
from arm_gazebo.ros.world_markers import WorldMarkerPublisher
from arm_gazebo.ros.world_parameters import WorldParameters
from arm_gazebo.run.run import SimulationRun
from arm_gazebo.state.run_reset import RunReset
from arm_gazebo.state.snapshots import SnapshotStore
from arm_gazebo.world.editor import LoopCall
from arm_gazebo.world.run_control import RunControl
from arm_node.executor_thread import ExecutorThread
from arm_node.qos import SERVICE_QOS

REPORT_PERIOD_S = 1.0
DEPTH = 10
PASSED = b"\x01"


class StatisticsPublisher:
    """Publishes the figures once per second of wall time while somebody subscribes.

    The node's executor may be blocked. The figures and `now_s`, the simulation time, belong to the
    loop thread, on which `on_loop` runs a function.
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
        node.create_timer(
            REPORT_PERIOD_S, self._publish, clock=Clock(clock_type=ClockType.STEADY_TIME)
        )
        node.create_service(SelfTest, "~/get_statistics", self._answer, qos_profile=SERVICE_QOS)

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


NODE_NAME = "simulation"


class SimulationServer:
    """Serves on its own node and thread, because requests wait for the loop and for compilation.

    Call `shutdown` before the loop ends, and `destroy_node` last. `resets_clock`, which any thread
    calls, returns whether a reset sets the clock to zero.
    """

    def __init__(
        self,
        run: SimulationRun,
        loop: ControlLoop,
        resets_clock: Callable[[], bool],
        cameras: Sequence[CameraFeed],
        statistics: SimulationStatistics,
        quit_process: Callable[[], None],
    ) -> None:
        # Another node of the process publishes the log.
        self._node = Node(NODE_NAME, enable_rosout=False)
        self._thread = ExecutorThread("simulation services", SingleThreadedExecutor())
        physics, editor = run.physics, run.editor
        reset = RunReset(run.state, editor, resets_clock, statistics.restart)
        control = RunControl(loop, reset.reset, quit_process)
        EntityServices(self._node, editor)
        WorldParameters(self._node, editor, run.properties)
        RunServices(self._node, editor, control, reset, run.loader, _about(physics.timing))
        snapshots = SnapshotStore(run.state, editor, lambda: run.world_name, statistics.restart)
        SnapshotServices(self._node, snapshots)
        StepServices(self._node, self._thread.executor, loop, control, cameras)
        StatisticsPublisher(self._node, statistics, lambda: physics.time_s, run.on_loop)
        WorldMarkerPublisher(self._node, editor)
        ContactMarkerPublisher(self._node, editor, physics)
        self._thread.executor.add_node(self._node)
        self._thread.start()

    def shutdown(self) -> None:
        """Stop the services; the loop still runs."""
        self._thread.stop()

    def destroy_node(self) -> None:
        """Destroy the node after the loop has ended."""
        self._node.destroy_node()


def _about(timing: PhysicsTiming) -> str:
    """Return the custom information for GetSimulatorFeatures."""
    return (
        f"a step is one control period of {timing.period_s:g} s, {timing.steps} physics steps of "
        f"{timing.step_s:g} s"
    )
