"""Puts the simulation together: model, hardware, controller manager, loop, clock, cameras, window.

Start: everything is made while time stands still, then the loop goes. End: the services stop,
the controllers are shut down on the loop, the loop is joined, and only then are nodes destroyed.
"""

import logging
from collections.abc import Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import ExitStack, closing, contextmanager
from typing import TYPE_CHECKING, Any

from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.node import Node

from arm_control.control_loop import ControlLoop
from arm_control.outbox import Outbox
from arm_control.pacer import Pacer
from arm_control.ros.controller_manager_node import ControllerManagerNode
from arm_gazebo.camera.feed import CameraFeed
from arm_gazebo.errors import SettingsError
from arm_gazebo.hardware.sensor_feed import SensorFeed
from arm_gazebo.hardware.simulated_hardware import SimulatedHardware
from arm_gazebo.mesh.cache import cache_folder
from arm_gazebo.model.builder import build_world
from arm_gazebo.physics.simulation import Simulation
from arm_gazebo.physics.tick import SimulationTick
from arm_gazebo.physics_timing import PhysicsTiming, physics_timing
from arm_gazebo.robot.build_options import BuildOptions
from arm_gazebo.robot.part import RobotInWorld
from arm_gazebo.ros.clock_publisher import RosClockPublisher
from arm_gazebo.ros.managed_robot import ManagedRobot
from arm_gazebo.ros.simulation_parameters import SimulationSettings, read_settings
from arm_gazebo.window.display import check_display
from arm_gazebo.window.feed import WindowFeed
from arm_node.discovery import answers_held_back
from arm_node.notify import notify
from arm_node.process import EXIT_FAILED, NodeProcess

if TYPE_CHECKING:
    from arm_gazebo.ros.simulation_server import SimulationServer

NODE_NAME = "arm_gazebo"
SUPERVISION_PERIOD_S = 0.5
LOOP_JOIN_TIMEOUT_S = 5.0

logger = logging.getLogger(NODE_NAME)


@contextmanager
def simulation_process(process: NodeProcess, arguments: Sequence[str]) -> Iterator[None]:
    """Build the simulation from the process's parameters, run it, and take it down.

    Raises:
        GazeboError, ArmControlError, DescriptionError: it cannot be built as asked for.
    """
    # What is made is taken down in reverse, from wherever the making stops. Nodes go last: one that
    # goes while the executor looks at it takes the process along.
    with ExitStack() as nodes, ExitStack() as ending:
        ending.callback(process.join_spinning)
        with answers_held_back():
            node = Node(NODE_NAME)
        nodes.callback(node.destroy_node)
        process.executor.add_node(node)
        settings = read_settings(node)
        outbox = Outbox()
        clock = RosClockPublisher(node, outbox)
        robots = []
        for robot_settings in settings.robots:
            robots.append(ManagedRobot(robot_settings, arguments, clock))
            nodes.callback(robots[-1].destroy_nodes)
        timing = _timing(robots, settings)
        entries = _entries(robots, settings, timing)
        built = build_world(entries, settings.world)
        built.report.log(logger)
        simulation = Simulation(built, timing, settings.hold_joints)
        for robot in robots:
            robot.drive(simulation, settings.seed)
        feeds = [
            ending.enter_context(closing(feed))
            for feed in _feeds(robots, settings, node.get_namespace())
        ]
        managers = [robot.manager for robot in robots]
        shown = [*feeds, *_sensor_feed(robots, node, timing)]
        tick = SimulationTick(managers, simulation, clock, shown, timing.period_s)
        loop = _loop(process, tick, timing, settings, robots[0].node, outbox)
        ending.enter_context(_standing_still(loop))
        for robot in robots:
            ending.callback(robot.shutdown)
            robot.serve(loop, process.executor)
        loop.resume()
        for feed in feeds:
            feed.start(built.model)
        hardware = [component for robot in robots for component in robot.hardware]
        _supervise(node, clock, loop.pacer, simulation, hardware, feeds)
        starter = ending.enter_context(ThreadPoolExecutor(1, "simulation services"))
        server = starter.submit(
            _serve, simulation, loop, entries, hardware, feeds, settings.world, process.stop
        )
        server.add_done_callback(lambda made: _check(made, process))
        nodes.callback(lambda: server.exception() or server.result().destroy_node())
        ending.callback(lambda: server.exception() or server.result().shutdown())
        yield


def _serve(*arguments: Any) -> "SimulationServer":
    """Serve simulation_interfaces; its messages take time to load, and the robot waits for none."""
    from arm_gazebo.ros.simulation_server import SimulationServer

    return SimulationServer(*arguments)


def _check(server: "Future[SimulationServer]", process: NodeProcess) -> None:
    """End the process where its services could not be made."""
    error = server.exception()
    if error is not None:
        logger.error("the services of the simulation failed", exc_info=error)
        process.stop(EXIT_FAILED)


def _loop(
    process: NodeProcess,
    tick: SimulationTick,
    timing: PhysicsTiming,
    settings: SimulationSettings,
    manager: ControllerManagerNode,
    outbox: Outbox,
) -> ControlLoop:
    """Make the loop that all robots share; the first one's manager says how it runs."""
    pacer = Pacer(
        timing.period_s,
        real_time_factor=settings.real_time_factor,
        print_warnings=manager.settings.overruns.print_warnings,
    )
    return ControlLoop(
        tick,
        pacer,
        on_failure=lambda _: process.stop(EXIT_FAILED),
        priority=manager.loop_priority(),
        outbox=outbox,
    )


@contextmanager
def _standing_still(loop: ControlLoop) -> Iterator[None]:
    """Start the loop, whose time stands still at first; end it and wait for that."""
    loop.start(paused=True)
    try:
        yield
    finally:
        loop.stop()
        loop.join(LOOP_JOIN_TIMEOUT_S)


def _timing(robots: Sequence[ManagedRobot], settings: SimulationSettings) -> PhysicsTiming:
    """Return period and step of the one loop that all robots share."""
    rates = {robot.node.settings.update_rate: robot.node for robot in robots}
    if len(rates) > 1:
        each = ", ".join(f"{n.get_fully_qualified_name()} {rate} Hz" for rate, n in rates.items())
        raise SettingsError(f"robots in one world have one update_rate, not several: {each}")
    return physics_timing(robots[0].node.settings.update_rate, settings.physics_step_s)


def _entries(
    robots: Sequence[ManagedRobot], settings: SimulationSettings, timing: PhysicsTiming
) -> list[RobotInWorld]:
    options = BuildOptions(
        step_s=timing.step_s,
        self_collide=settings.self_collide,
        strict=settings.strict,
        mesh_cache=cache_folder(),
    )
    return [robot.in_world(options) for robot in robots]


def _feeds(
    robots: Sequence[ManagedRobot], settings: SimulationSettings, namespace: str
) -> Iterator[CameraFeed | WindowFeed]:
    """Make what shows the simulation.

    Raises:
        WindowError: a window is asked for where there is no display.
    """
    if not settings.headless:
        check_display()
        yield WindowFeed()
    cameras = [camera for robot in robots for camera in robot.cameras]
    if cameras:
        ros_arguments = ("-r", f"__ns:={namespace}")
        yield CameraFeed(cameras, settings.render_backend, settings.seed, ros_arguments)


def _sensor_feed(
    robots: Sequence[ManagedRobot], node: Node, timing: PhysicsTiming
) -> Iterator[SensorFeed]:
    """Make what publishes the robots' sensors; nothing where there are none."""
    instruments = [instrument for robot in robots for instrument in robot.instruments]
    if instruments:
        # Only here: messages take time to load, and most robots have no sensors.
        from arm_gazebo.ros.sensor_publisher import sensor_publisher

        sinks = [sensor_publisher(node, instrument.sensor) for instrument in instruments]
        yield SensorFeed(instruments, sinks, timing.period_s)


def _supervise(
    node: Node,
    clock: RosClockPublisher,
    pacer: Pacer,
    simulation: Simulation,
    hardware: Sequence[SimulatedHardware],
    feeds: Sequence[CameraFeed | WindowFeed],
) -> None:
    """Now and then: pass on what the loop may not log itself, look after child processes."""

    def look() -> None:
        for component in hardware:
            for warning in component.take_warnings():
                logger.warning("%s", warning)
        warning = clock.take_warning()
        if warning is not None:
            logger.warning("%s", warning)
        for failure in simulation.take_failures():
            logger.error("%s", failure)
        for feed in feeds:
            feed.supervise()
        factor = pacer.statistics.achieved_factor
        if factor:  # 0 until there is something to average
            notify(f"STATUS=real-time factor {factor:.2f}")

    node.create_timer(SUPERVISION_PERIOD_S, look, clock=Clock(clock_type=ClockType.STEADY_TIME))
