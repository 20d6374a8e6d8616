"""Assemble the simulation: model, hardware, controller manager, loop, clock, cameras, window.

Start: everything is created while the loop is paused, then the loop resumes. End: the services
stop, the controllers shut down on the loop, the loop is joined, and then the nodes are destroyed.
"""

import logging
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import ExitStack, closing, contextmanager
from functools import partial
from typing import TYPE_CHECKING, Any

from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.executors import Executor
from rclpy.node import Node

from arm_control.loop.control_loop import ControlLoop
from arm_control.loop.lock_step import LockStep
from arm_control.loop.outbox import Outbox
from arm_control.loop.pacer import Pacer
from arm_control.manager.controller_manager import ControllerManager
from arm_control.manager.ros.controller_manager_node import ControllerManagerNode
from arm_control.manager.ros.controller_node import controllers_executor
from arm_control.manager.ros.emergency_stop import EmergencyStopServer
from arm_gazebo.camera.feed import CameraFeed
from arm_gazebo.faults.injector import FaultInjector
from arm_gazebo.hardware.simulated_hardware import SimulatedHardware
from arm_gazebo.hardware.simulated_sensors import SensorFeed, SimulatedSensor
from arm_gazebo.physics.physics import Physics
from arm_gazebo.physics.statistics import SimulationStatistics
from arm_gazebo.physics.tick import SimulationTick
from arm_gazebo.physics_timing import PhysicsTiming
from arm_gazebo.recording.session import RunParts
from arm_gazebo.ros.clock_publisher import RosClockPublisher
from arm_gazebo.ros.fault_parameter import FaultParameter
from arm_gazebo.ros.live_parameters import follow_parameter
from arm_gazebo.ros.managed_robot import ManagedRobot
from arm_gazebo.ros.run_recording import RunRecording
from arm_gazebo.run.settings import SimulationSettings, read_above_zero, simulation_settings
from arm_gazebo.run.world import AssembledWorld, assemble_world
from arm_gazebo.state.complete_state import CompleteState
from arm_gazebo.window.display import check_display
from arm_gazebo.window.feed import WindowFeed
from arm_node.notify import notify
from arm_node.parameter_values import read_non_negative
from arm_node.parameters import declare
from arm_node.process import EXIT_FAILED, NodeProcess
from arm_node.workarounds.discovery import first_node

if TYPE_CHECKING:
    from arm_gazebo.ros.simulation_server import SimulationServer

NODE_NAME = "arm_gazebo"
SUPERVISION_PERIOD_S = 0.5
LOOP_JOIN_TIMEOUT_S = 5.0

logger = logging.getLogger(NODE_NAME)


@contextmanager
def simulation_process(process: NodeProcess, arguments: Sequence[str]) -> Iterator[None]:
    """Build the simulation from the process's parameters, run it, and tear it down.

    Raises:
        GazeboError, ArmControlError, DescriptionError: it cannot be built.
    """
    # Everything is torn down in reverse order, also after a failure half-way. Nodes come last:
    # destroying one while the executor uses it crashes the process.
    with ExitStack() as nodes, ExitStack() as ending:
        ending.callback(process.join_spinning)
        node = first_node(lambda: Node(NODE_NAME))
        nodes.callback(node.destroy_node)
        process.executor.add_node(node)
        settings = simulation_settings(partial(declare, node))
        outbox = Outbox()
        clock = RosClockPublisher(node, outbox)
        # A lock-step takes the commands out of the process's executor.
        executor = (
            process.executor if settings.lockstep else ending.enter_context(controllers_executor())
        )
        robots = []
        for robot_settings in settings.robots:
            robots.append(ManagedRobot(robot_settings, arguments, clock.of_nodes))
            nodes.callback(robots[-1].destroy_nodes)
        world = assemble_world(
            [robot.robot for robot in robots], settings, _update_rates_hz(robots)
        )
        simulation, timing = world.simulation, world.simulation.timing
        for robot in robots:
            robot.drive(simulation, settings.seed)
        feeds = [
            ending.enter_context(closing(feed))
            for feed in _feeds(robots, settings, node.get_namespace())
        ]
        managers = [robot.robot.manager for robot in robots]
        consumers = [*feeds, *_sensor_feed(robots, node, timing)]
        cameras = [feed for feed in feeds if isinstance(feed, CameraFeed)]
        tick = SimulationTick(managers, simulation, clock, consumers, timing.period_s)
        loop = _loop(process, tick, simulation, settings, robots[0].node, outbox)
        _follow_pace(node, process.executor, loop, nodes, ending)
        FaultParameter(node, FaultInjector(simulation, managers, tick, _sensors(robots)), loop)
        ending.enter_context(_started_paused(loop))
        state = _complete_state(simulation, managers, consumers, clock)
        run = _parts(robots, settings, simulation, state, tick, loop)
        recording = ending.enter_context(closing(RunRecording(node, run, settings.record_run)))
        _serve_robots(robots, executor, loop, ending)
        _serve_all(robots, node, loop, process.executor)
        if not settings.paused:
            loop.resume()
        for feed in feeds:
            feed.start(simulation.model)
        hardware = [component for robot in robots for component in robot.robot.hardware]
        _supervise(node, clock, loop.pacer, simulation, hardware, [*feeds, recording])
        statistics = _statistics(simulation, tick, loop, consumers)
        serving = (state, partial(_is_set, node, "reset_clock"), loop, settings.spawn_limit)
        serving = (world, *serving, hardware, feeds, cameras, statistics, process.stop)
        _start_services(process, nodes, ending, serving)
        _remark(world)
        yield


def _serve_robots(
    robots: Sequence[ManagedRobot],
    executor: Executor,
    loop: ControlLoop,
    ending: ExitStack,
) -> None:
    """Serve each robot's manager.

    Raises:
        ArmControlError: a required controller cannot start.
    """
    for robot in robots:
        ending.callback(robot.shutdown)
        robot.serve(loop, executor)


def _serve_all(
    robots: Sequence[ManagedRobot], node: Node, loop: ControlLoop, executor: Executor
) -> None:
    """Serve the emergency stop of all robots, unless one of them has it."""
    namespaces = {robot.node.get_namespace() for robot in robots}
    if node.get_namespace() not in namespaces:
        managers = [robot.robot.manager for robot in robots]
        EmergencyStopServer(node, executor, loop, managers)


def _complete_state(
    simulation: Physics,
    managers: Sequence[ControllerManager],
    feeds: Sequence[CameraFeed | WindowFeed | SensorFeed],
    clock: RosClockPublisher,
) -> CompleteState:
    scheduled = [feed for feed in feeds if not isinstance(feed, WindowFeed)]
    return CompleteState(simulation, managers, scheduled, clock)


def _statistics(
    simulation: Physics,
    tick: SimulationTick,
    loop: ControlLoop,
    feeds: Sequence[CameraFeed | WindowFeed | SensorFeed],
) -> SimulationStatistics:
    streams = [feed.counts for feed in feeds if not isinstance(feed, WindowFeed)]
    return SimulationStatistics(simulation, tick.costs, loop.pacer, streams)


def _remark(world: AssembledWorld) -> None:
    """Log which parts of the world are not simulated."""
    if world.left_out:
        remark = f"world {world.named.name}: {world.left_out}"
        logger.warning("%s", remark)
        notify(f"X_REMARK={remark}")


def _parts(
    robots: Sequence[ManagedRobot],
    settings: SimulationSettings,
    simulation: Physics,
    state: CompleteState,
    tick: SimulationTick,
    loop: ControlLoop,
) -> RunParts:
    """Return what a recording needs of the run."""
    each = zip(robots, settings.robots, strict=True)
    return RunParts(
        simulation,
        state,
        tick,
        loop,
        [(robot.robot, of_robot, robot.node.settings) for robot, of_robot in each],
        settings.hold_joints,
        settings.position_proportional_gain,
        settings.seed,
    )


def _start_services(
    process: NodeProcess, nodes: ExitStack, ending: ExitStack, serving: tuple[Any, ...]
) -> None:
    """Start the services on a thread of their own; the two exit stacks stop and destroy them."""
    starter = ending.enter_context(ThreadPoolExecutor(1, "simulation services"))
    server = starter.submit(_serve, *serving)
    server.add_done_callback(lambda made: _check(made, process))
    nodes.callback(lambda: server.exception() or server.result().destroy_node())
    ending.callback(lambda: server.exception() or server.result().shutdown())


def _serve(*arguments: Any) -> "SimulationServer":
    """Serve simulation_interfaces; the robot does not wait while its messages load."""
    from arm_gazebo.ros.simulation_server import SimulationServer

    return SimulationServer(*arguments)


def _check(server: "Future[SimulationServer]", process: NodeProcess) -> None:
    """End the process if its services could not be created."""
    error = server.exception()
    if error is not None:
        logger.error("the services of the simulation failed", exc_info=error)
        process.stop(EXIT_FAILED)


def _loop(
    process: NodeProcess,
    tick: SimulationTick,
    simulation: Physics,
    settings: SimulationSettings,
    manager: ControllerManagerNode,
    outbox: Outbox,
) -> ControlLoop:
    """Create the loop that all robots share, with the settings of the first robot's manager."""
    lock_step = None
    if settings.lockstep:
        lock_step = LockStep(settings.lockstep, settings.lockstep_timeout_s)
    pacer = Pacer(
        simulation.timing.period_s,
        real_time_factor=settings.real_time_factor,
        print_warnings=manager.settings.overruns.print_warnings,
    )
    return ControlLoop(
        tick if lock_step is None else _answered_ticks(tick, simulation, lock_step),
        pacer,
        on_failure=lambda _: process.stop(EXIT_FAILED),
        priority=manager.loop_priority(),
        outbox=outbox,
        lock_step=lock_step,
    )


def _is_set(node: Node, parameter: str) -> bool:
    return bool(node.get_parameter(parameter).value)


def _answered_ticks(
    tick: SimulationTick, simulation: Physics, lock_step: LockStep
) -> Callable[[], None]:
    """Return a tick after which the partners' answers are awaited."""

    def run() -> None:
        lock_step.begin_tick()
        tick()
        lock_step.end_tick(simulation.time_s)

    return run


def _follow_partners(
    node: Node,
    executor: Executor,
    loop: ControlLoop,
    lock_step: LockStep,
    nodes: ExitStack,
    ending: ExitStack,
) -> None:
    """Listen to the partners of a lock-stepped simulation."""
    # Imported only here, because most simulations have no partners.
    from arm_gazebo.ros.lock_step_partners import LockStepPartners

    partners = LockStepPartners(node, executor, loop, lock_step)
    nodes.callback(partners.destroy)
    ending.callback(partners.shutdown)
    lock_step.add_source(partners.take_commands)

    def set_timeout(timeout_s: float) -> None:
        loop.call(lambda: lock_step.set_timeout(timeout_s))

    follow_parameter(node, "lockstep_timeout", read_above_zero, set_timeout)


def _follow_pace(
    node: Node, executor: Executor, loop: ControlLoop, nodes: ExitStack, ending: ExitStack
) -> None:
    """Let clients change the pace, and with a lock-step its partners."""
    follow_parameter(node, "real_time_factor", read_non_negative, partial(_set_speed, loop))
    if loop.lock_step is not None:
        _follow_partners(node, executor, loop, loop.lock_step, nodes, ending)


def _set_speed(loop: ControlLoop, factor: float) -> None:
    """Change the pace between two ticks; a loop that waits for its next tick starts it at once."""

    def change() -> None:
        loop.pacer.real_time_factor = factor

    loop.call(change)


@contextmanager
def _started_paused(loop: ControlLoop) -> Iterator[None]:
    """Start the loop paused; on exit, stop and join it."""
    loop.start(paused=True)
    try:
        yield
    finally:
        loop.stop()
        loop.join(LOOP_JOIN_TIMEOUT_S)


def _update_rates_hz(robots: Sequence[ManagedRobot]) -> dict[str, int]:
    """Return the update rate of each robot's manager by the name of its node."""
    nodes = [robot.node for robot in robots]
    return {node.get_fully_qualified_name(): node.settings.update_rate for node in nodes}


def _feeds(
    robots: Sequence[ManagedRobot], settings: SimulationSettings, namespace: str
) -> Iterator[CameraFeed | WindowFeed]:
    """Create the feeds of window and cameras.

    Raises:
        WindowError: a window is requested but there is no display.
    """
    if not settings.headless:
        check_display()
        yield WindowFeed()
    cameras = [camera for robot in robots for camera in robot.robot.cameras]
    if cameras:
        ros_arguments = ("-r", f"__ns:={namespace}")
        yield CameraFeed(cameras, settings.render_backend, settings.seed, ros_arguments)


def _sensors(robots: Sequence[ManagedRobot]) -> list[SimulatedSensor]:
    return [sensor for robot in robots for sensor in robot.robot.sensors]


def _sensor_feed(
    robots: Sequence[ManagedRobot], node: Node, timing: PhysicsTiming
) -> Iterator[SensorFeed]:
    """Create the feed of the robots' sensors, if there are any."""
    sensors = _sensors(robots)
    if sensors:
        # Imported only here, because messages load slowly and most robots have no sensors.
        from arm_gazebo.ros.sensor_publisher import SensorPublisher

        sinks = [SensorPublisher(node, sensor.description) for sensor in sensors]
        yield SensorFeed(sensors, sinks, timing.period_s)


def _supervise(
    node: Node,
    clock: RosClockPublisher,
    pacer: Pacer,
    simulation: Physics,
    hardware: Sequence[SimulatedHardware],
    supervised: Sequence[CameraFeed | WindowFeed | RunRecording],
) -> None:
    """Periodically log what the loop must not log itself, and supervise child processes."""

    def check() -> None:
        for component in hardware:
            for warning in component.take_warnings():
                logger.warning("%s", warning)
        warning = clock.take_warning()
        if warning is not None:
            logger.warning("%s", warning)
        for failure in simulation.take_failures():
            logger.error("%s", failure)
        for part in supervised:
            part.supervise()
        factor = pacer.statistics.achieved_factor
        if factor:  # 0 until there is something to average
            notify(f"STATUS=real-time factor {factor:.2f}")

    node.create_timer(SUPERVISION_PERIOD_S, check, clock=Clock(clock_type=ClockType.STEADY_TIME))
