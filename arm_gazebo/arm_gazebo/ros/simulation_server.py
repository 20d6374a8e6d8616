"""Serves simulation_interfaces: the world and its things, and the time that passes in it."""

from collections.abc import Callable, Sequence
from concurrent.futures import TimeoutError as FutureTimeoutError
from typing import TypeVar

from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node

from arm_control.control_loop import ControlLoop
from arm_control.errors import LoopStoppedError
from arm_gazebo.model.world_path import find_world
from arm_gazebo.physics.simulation import Simulation
from arm_gazebo.physics_timing import PhysicsTiming
from arm_gazebo.robot.part import RobotInWorld
from arm_gazebo.ros.entity_services import EntityServices
from arm_gazebo.ros.run_services import RunServices
from arm_gazebo.ros.world_marker_publisher import WorldMarkerPublisher
from arm_gazebo.world.keeper import ModelFeed, ModelHolder, WorldKeeper
from arm_gazebo.world.loading import WorldLoader, named_world
from arm_gazebo.world.refusal import Refusal, RefusedError
from arm_gazebo.world.run_control import RunControl
from arm_gazebo.world.spawn_model import ModelSource
from arm_node.executor_thread import ExecutorThread

ResultT = TypeVar("ResultT")

NODE_NAME = "simulation"
LOOP_TIMEOUT_S = 10.0


class SimulationServer:
    """A node of its own on a thread of its own: the services wait for the loop and for compilers.

    From its making until `shutdown`, which comes before the end of the loop; `destroy_node` last.

    Args:
        simulation: belongs to the loop.
        loop: runs it; started already, paused or not.
        entries: the robots.
        holders: look up their places in a new model.
        feeds: show a new model.
        world: name or path of the world that was built.
        quit_process: asks the process to end.
    """

    def __init__(
        self,
        simulation: Simulation,
        loop: ControlLoop,
        entries: Sequence[RobotInWorld],
        holders: Sequence[ModelHolder],
        feeds: Sequence[ModelFeed],
        world: str,
        quit_process: Callable[[], None],
    ) -> None:
        self._loop = loop
        # Nobody sets parameters of it, and the process's other nodes log.
        self._node = Node(NODE_NAME, start_parameter_services=False, enable_rosout=False)
        self._thread = ExecutorThread("simulation services", SingleThreadedExecutor())
        options = entries[0].options
        folders = tuple(dict.fromkeys(f for e in entries for f in e.options.package_path))
        source = ModelSource(options.step_s, folders, options.mesh_cache)
        keeper = WorldKeeper(simulation, self._on_loop, holders, feeds, source)
        run = RunControl(loop, lambda: keeper.reset(spawned=True, state=True), quit_process)
        EntityServices(self._node, keeper)
        RunServices(
            self._node,
            self._thread.executor,
            keeper,
            run,
            WorldLoader(entries),
            named_world(find_world(world)),
            _about(simulation.timing),
        )
        WorldMarkerPublisher(self._node, keeper)
        self._thread.executor.add_node(self._node)
        self._thread.start()

    def shutdown(self) -> None:
        """Serve no more; the loop still runs."""
        self._thread.stop()

    def destroy_node(self) -> None:
        """Destroy the node; the loop has ended."""
        self._node.destroy_node()

    def _on_loop(self, function: Callable[[], ResultT], /) -> ResultT:
        call = self._loop.call(function)
        try:
            return call.result(LOOP_TIMEOUT_S)
        except FutureTimeoutError as error:
            if not call.cancel():
                # It is under way, or was done just now.
                return call.result()
            raise RefusedError(
                Refusal.FAILED, f"the simulation did not get to it within {LOOP_TIMEOUT_S:g} s"
            ) from error
        except LoopStoppedError as error:
            raise RefusedError(Refusal.FAILED, str(error)) from error


def _about(timing: PhysicsTiming) -> str:
    """Return what the features do not tell."""
    return (
        f"a step is one control period of {timing.period_s:g} s, {timing.steps} physics steps of "
        f"{timing.step_s:g} s; time never goes back"
    )
