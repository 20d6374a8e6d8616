"""Serve simulation_interfaces: the world, its entities and the simulation's run state."""

from collections.abc import Callable, Sequence

from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node

from arm_control.loop.control_loop import ControlLoop
from arm_gazebo.camera.feed import CameraFeed
from arm_gazebo.physics.statistics import SimulationStatistics
from arm_gazebo.physics_timing import PhysicsTiming
from arm_gazebo.ros.entity_services import EntityServices
from arm_gazebo.ros.run_services import RunServices
from arm_gazebo.ros.snapshot_services import SnapshotServices
from arm_gazebo.ros.statistics_publisher import StatisticsPublisher
from arm_gazebo.ros.step_services import StepServices
from arm_gazebo.ros.world_marker_publisher import WorldMarkerPublisher
from arm_gazebo.run.run import SimulationRun
from arm_gazebo.state.run_reset import RunReset
from arm_gazebo.state.snapshots import SnapshotStore
from arm_gazebo.world.run_control import RunControl
from arm_node.executor_thread import ExecutorThread

NODE_NAME = "simulation"


class SimulationServer:
    """Serves on its own node and thread, because requests wait for the loop and for compilation.

    Call `shutdown` before the loop ends, and `destroy_node` last.

    Args:
        run: the run, which belongs to the loop.
        loop: runs it; already started, paused or not.
        resets_clock: returns whether a reset sets the clock to zero; any thread.
        cameras: the feeds of cameras.
        statistics: the figures of the run, which belong to the loop.
        quit_process: asks the process to end.
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
        RunServices(self._node, editor, control, reset, run.loader, _about(physics.timing))
        snapshots = SnapshotStore(run.state, editor, lambda: run.world_name, statistics.restart)
        SnapshotServices(self._node, snapshots)
        StepServices(self._node, self._thread.executor, loop, control, cameras)
        StatisticsPublisher(self._node, statistics, lambda: physics.time_s, run.on_loop)
        WorldMarkerPublisher(self._node, editor)
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
