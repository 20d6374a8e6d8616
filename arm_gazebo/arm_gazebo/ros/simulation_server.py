"""Serve simulation_interfaces: the world, its entities and the simulation's run state."""

from collections.abc import Callable, Sequence
from concurrent.futures import TimeoutError as FutureTimeoutError
from typing import TypeVar

from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node

from arm_control.errors import LoopStoppedError
from arm_control.loop.control_loop import ControlLoop
from arm_gazebo.camera.feed import CameraFeed
from arm_gazebo.mjcf.memory_limit import MemoryLimit
from arm_gazebo.physics.statistics import SimulationStatistics
from arm_gazebo.physics_timing import PhysicsTiming
from arm_gazebo.ros.entity_services import EntityServices
from arm_gazebo.ros.run_services import RunServices
from arm_gazebo.ros.snapshot_services import SnapshotServices
from arm_gazebo.ros.statistics_publisher import StatisticsPublisher
from arm_gazebo.ros.step_services import StepServices
from arm_gazebo.ros.world_marker_publisher import WorldMarkerPublisher
from arm_gazebo.run.world import AssembledWorld
from arm_gazebo.state.complete_state import CompleteState
from arm_gazebo.state.run_reset import RunReset
from arm_gazebo.state.snapshots import SnapshotStore
from arm_gazebo.world.editor import ModelFeed, ModelHolder, WorldEditor
from arm_gazebo.world.loading import WorldLoader
from arm_gazebo.world.refusal import Refusal, RequestError
from arm_gazebo.world.run_control import RunControl
from arm_node.executor_thread import ExecutorThread

ResultT = TypeVar("ResultT")

NODE_NAME = "simulation"
LOOP_TIMEOUT_S = 10.0


class SimulationServer:
    """Serves on its own node and thread, because requests wait for the loop and for compilation.

    Call `shutdown` before the loop ends, and `destroy_node` last.

    Args:
        world: the robots in their world; the simulation belongs to the loop.
        state: the state of the run, which belongs to the loop as well.
        resets_clock: returns whether a reset sets the clock to zero; any thread.
        loop: the loop that runs it; already started, paused or not.
        spawn_limit: limit on the memory of a spawned MJCF.
        holders: look up their indices in a new model.
        feeds: show a new model.
        cameras: the feeds of cameras among them.
        statistics: the figures of the run, which belong to the loop.
        quit_process: asks the process to end.
    """

    def __init__(
        self,
        world: AssembledWorld,
        state: CompleteState,
        resets_clock: Callable[[], bool],
        loop: ControlLoop,
        spawn_limit: MemoryLimit,
        holders: Sequence[ModelHolder],
        feeds: Sequence[ModelFeed],
        cameras: Sequence[CameraFeed],
        statistics: SimulationStatistics,
        quit_process: Callable[[], None],
    ) -> None:
        self._loop = loop
        # Another node of the process publishes the log.
        self._node = Node(NODE_NAME, enable_rosout=False)
        self._thread = ExecutorThread("simulation services", SingleThreadedExecutor())
        simulation, source = world.simulation, world.model_source(spawn_limit)
        editor = WorldEditor(simulation, self._on_loop, holders, feeds, source)
        reset = RunReset(state, editor, resets_clock, statistics.restart)
        run = RunControl(loop, reset.reset, quit_process)
        EntityServices(self._node, editor)
        services = RunServices(
            self._node,
            editor,
            run,
            reset,
            WorldLoader(world.entries, source.trial),
            world.named,
            _about(simulation.timing),
        )
        snapshots = SnapshotStore(
            state,
            editor,
            self._on_loop,
            source,
            lambda: services.world_name,
            statistics.restart,
        )
        SnapshotServices(self._node, snapshots)
        StepServices(self._node, self._thread.executor, loop, run, cameras)
        StatisticsPublisher(self._node, statistics, lambda: simulation.time_s, self._on_loop)
        WorldMarkerPublisher(self._node, editor)
        self._thread.executor.add_node(self._node)
        self._thread.start()

    def shutdown(self) -> None:
        """Stop the services; the loop still runs."""
        self._thread.stop()

    def destroy_node(self) -> None:
        """Destroy the node after the loop has ended."""
        self._node.destroy_node()

    def _on_loop(self, function: Callable[[], ResultT], /) -> ResultT:
        call = self._loop.call(function)
        try:
            return call.result(LOOP_TIMEOUT_S)
        except FutureTimeoutError as error:
            if not call.cancel():
                # The call is running, or has just finished.
                return call.result()
            raise RequestError(
                Refusal.FAILED,
                f"the simulation did not respond within {LOOP_TIMEOUT_S:g} s",
            ) from error
        except LoopStoppedError as error:
            raise RequestError(Refusal.FAILED, str(error)) from error


def _about(timing: PhysicsTiming) -> str:
    """Return the custom information for GetSimulatorFeatures."""
    return (
        f"a step is one control period of {timing.period_s:g} s, {timing.steps} physics steps of "
        f"{timing.step_s:g} s"
    )
