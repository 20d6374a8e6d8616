"""Assemble the simulation: model, hardware, controller manager, loop, clock, cameras, window.

Start: everything is created while the loop is paused, then the loop resumes. End: the services
stop, the controllers shut down on the loop, the loop is joined, and then the nodes are destroyed.
"""

import logging
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import ExitStack, closing, contextmanager
from functools import partial
from typing import TYPE_CHECKING

from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.executors import Executor
from rclpy.node import Node

from arm_control.loop.control_loop import ControlLoop
from arm_control.loop.lock_step import LockStep
from arm_control.loop.outbox import Outbox
from arm_control.loop.pacer import Pacer
from arm_control.manager.ros.controller_manager_node import ControllerManagerNode
from arm_control.manager.ros.controller_manager_server import ControllerManagerServer
from arm_control.manager.ros.controller_node import controllers_executor
from arm_control.manager.ros.emergency_stop import EmergencyStopServer
from arm_gazebo.camera.feed import CameraFeed
from arm_gazebo.faults.injector import FaultInjector
from arm_gazebo.hardware.simulated_sensors import SensorFeed
from arm_gazebo.physics.statistics import SimulationStatistics
from arm_gazebo.ros.clock_publisher import RosClockPublisher
from arm_gazebo.ros.live_parameters import FaultParameter, RunRecording, follow_setting
from arm_gazebo.run.robot import ManagedRobot, SimulatedRobot
from arm_gazebo.run.run import SimulationRun
from arm_gazebo.run.settings import RobotSettings, SimulationSettings, simulation_settings
from arm_gazebo.window.display import check_display
from arm_gazebo.window.process import WindowFeed
from arm_node.notify import notify
from arm_node.parameters import declare_setting
from arm_node.process import EXIT_FAILED, NodeProcess
from arm_node.setting import setting_of
from arm_node.workarounds.clocks import ProcessClock
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
        settings = simulation_settings(partial(declare_setting, node))
        outbox = Outbox()
        clock = RosClockPublisher(node, outbox)
        # A lock-step takes the commands out of the process's executor.
        executor = (
            process.executor if settings.lockstep else ending.enter_context(controllers_executor())
        )
        robots: list[_RobotNodes] = []
        for robot_settings in settings.robots:
            robots.append(_RobotNodes(robot_settings, arguments, clock.of_nodes))
            nodes.callback(robots[-1].destroy)
        run = SimulationRun.of(settings, [robot.managed for robot in robots], clock)
        loop = run.loop = _loop(process, run, settings, robots[0].node, outbox)
        viewers = [
            ending.enter_context(closing(feed))
            for feed in _viewers(run, settings, node.get_namespace())
        ]
        cameras = [feed for feed in viewers if isinstance(feed, CameraFeed)]
        streams = _fed(run, viewers, cameras, list(_sensor_feed(run, node)))
        _follow_pace(node, process.executor, loop, nodes, ending)
        FaultParameter(node, FaultInjector(run), loop)
        ending.enter_context(_started_paused(loop))
        recording = ending.enter_context(closing(RunRecording(node, run, settings.record_run)))
        for nodes_of_robot, robot in zip(robots, run.robots, strict=True):
            ending.callback(nodes_of_robot.shutdown)
            nodes_of_robot.serve(robot, loop, executor)
        _serve_all(robots, run, node, loop, process.executor)
        for feed in viewers:
            # Before the first step, because steps change the model while they run.
            feed.start(run.physics.model)
        if not settings.paused:
            loop.resume()
        _supervise(node, clock, loop.pacer, run, [*viewers, recording])
        statistics = SimulationStatistics(
            run.physics, run.tick.costs, loop.pacer, [feed.counts for feed in streams]
        )

        def serve() -> "SimulationServer":
            # Imported on its own thread: the robot does not wait while the messages load.
            from arm_gazebo.ros.simulation_server import SimulationServer

            resets_clock = partial(_is_set, node, "reset_clock")
            return SimulationServer(run, loop, resets_clock, cameras, statistics, process.stop)

        _start_services(process, nodes, ending, serve)
        _remark(run)
        yield


class _RobotNodes:
    """The nodes of one robot: its controller manager's, and from `serve` on all others.

    Attributes:
        node: the manager's node.
        managed: the settings of the robot and of its manager.
    """

    def __init__(
        self, settings: RobotSettings, arguments: Sequence[str], clock: ProcessClock
    ) -> None:
        self._server: ControllerManagerServer | None = None
        self.node = ControllerManagerNode(arguments, namespace=settings.namespace, clock=clock)
        name = self.node.get_fully_qualified_name()
        self.managed = ManagedRobot(settings, self.node.settings, name)

    def serve(self, robot: SimulatedRobot, loop: ControlLoop, executor: Executor) -> None:
        """Create the manager's services and start the requested controllers.

        Raises:
            ArmControlError: a required controller cannot start.
        """
        self._server = server = ControllerManagerServer(
            self.node, robot.manager, loop, executor, robot_description=robot.document
        )
        robot.start_controllers(
            lambda name: server.start_controllers((name,)), logging.getLogger("controller_manager")
        )

    def shutdown(self) -> None:
        """Stop the services; the loop still runs."""
        if self._server is not None:
            self._server.shutdown()

    def destroy(self) -> None:
        """Destroy every node of the robot after the loop has ended."""
        if self._server is None:
            self.node.destroy_node()
        else:
            self._server.destroy_nodes()


def _serve_all(
    robots: Sequence[_RobotNodes],
    run: SimulationRun,
    node: Node,
    loop: ControlLoop,
    executor: Executor,
) -> None:
    """Serve the emergency stop of all robots, unless one of them has it."""
    namespaces = {robot.node.get_namespace() for robot in robots}
    if node.get_namespace() not in namespaces:
        EmergencyStopServer(node, executor, loop, run.managers)


def _remark(run: SimulationRun) -> None:
    """Log which parts of the world are not simulated."""
    left_out, world = run.physics.built.report.left_out, run.loader.world
    if left_out and world is not None:
        remark = f"world {world.name}: {left_out}"
        logger.warning("%s", remark)
        notify(f"X_REMARK={remark}")


def _start_services(
    process: NodeProcess,
    nodes: ExitStack,
    ending: ExitStack,
    serve: "Callable[[], SimulationServer]",
) -> None:
    """Start the services on a thread of their own; the two exit stacks stop and destroy them."""
    starter = ending.enter_context(ThreadPoolExecutor(1, "simulation services"))
    server = starter.submit(serve)
    server.add_done_callback(lambda made: _check(made, process))
    nodes.callback(lambda: server.exception() or server.result().destroy_node())
    ending.callback(lambda: server.exception() or server.result().shutdown())


def _check(server: "Future[SimulationServer]", process: NodeProcess) -> None:
    """End the process if its services could not be created."""
    error = server.exception()
    if error is not None:
        logger.error("the services of the simulation failed", exc_info=error)
        process.stop(EXIT_FAILED)


def _loop(
    process: NodeProcess,
    run: SimulationRun,
    settings: SimulationSettings,
    manager: ControllerManagerNode,
    outbox: Outbox,
) -> ControlLoop:
    """Create the loop that all robots share, with the settings of the first robot's manager."""
    lock_step = None
    if settings.lockstep:
        lock_step = LockStep(settings.lockstep, settings.lockstep_timeout_s)
    pacer = Pacer(
        run.physics.timing.period_s,
        real_time_factor=settings.real_time_factor,
        print_warnings=manager.settings.overruns.print_warnings,
    )
    return ControlLoop(
        run.tick if lock_step is None else _answered_ticks(run, lock_step),
        pacer,
        on_failure=lambda _: process.stop(EXIT_FAILED),
        priority=manager.loop_priority(),
        outbox=outbox,
        lock_step=lock_step,
    )


def _is_set(node: Node, parameter: str) -> bool:
    return bool(node.get_parameter(parameter).value)


def _answered_ticks(run: SimulationRun, lock_step: LockStep) -> Callable[[], None]:
    """Return a tick after which the partners' answers are awaited."""

    def tick() -> None:
        lock_step.begin_tick()
        run.tick()
        lock_step.end_tick(run.physics.time_s)

    return tick


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

    follow_setting(node, setting_of(SimulationSettings, "lockstep_timeout_s"), set_timeout)


def _follow_pace(
    node: Node, executor: Executor, loop: ControlLoop, nodes: ExitStack, ending: ExitStack
) -> None:
    """Let clients change the pace, and with a lock-step its partners."""
    factor = setting_of(SimulationSettings, "real_time_factor")
    follow_setting(node, factor, partial(_set_speed, loop))
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


def _viewers(
    run: SimulationRun, settings: SimulationSettings, namespace: str
) -> Iterator[CameraFeed | WindowFeed]:
    """Create the feeds of window and cameras.

    Raises:
        WindowError: a window is requested but there is no display.
    """
    if not settings.headless:
        check_display()
        yield WindowFeed()
    if run.cameras:
        ros_arguments = ("-r", f"__ns:={namespace}")
        yield CameraFeed(run.cameras, settings.render_backend, settings.seed, ros_arguments)


def _sensor_feed(run: SimulationRun, node: Node) -> Iterator[SensorFeed]:
    """Create the feed of the robots' sensors, if there are any."""
    if run.sensors:
        # Imported only here, because messages load slowly and most robots have no sensors.
        from arm_gazebo.ros.sensor_publisher import SensorPublisher

        sinks = [SensorPublisher(node, sensor.description) for sensor in run.sensors]
        yield SensorFeed(run.sensors, sinks, run.physics.timing.period_s)


def _fed(
    run: SimulationRun,
    viewers: Sequence[CameraFeed | WindowFeed],
    cameras: Sequence[CameraFeed],
    sensors: Sequence[SensorFeed],
) -> list[CameraFeed | SensorFeed]:
    """Connect the feeds with the run; return those with rates, which are part of its state."""
    run.viewers.extend(viewers)
    for feed in (*viewers, *sensors):
        run.tick.add_feed(feed)
    streams = [*cameras, *sensors]
    for feed in streams:
        run.state.add_schedule(feed.schedule)
    return streams


def _supervise(
    node: Node,
    clock: RosClockPublisher,
    pacer: Pacer,
    run: SimulationRun,
    supervised: Sequence[CameraFeed | WindowFeed | RunRecording],
) -> None:
    """Periodically log what the loop must not log itself, and supervise child processes."""

    def check() -> None:
        run.log_findings(logger)
        warning = clock.take_warning()
        if warning is not None:
            logger.warning("%s", warning)
        for part in supervised:
            part.supervise()
        factor = pacer.statistics.achieved_factor
        if factor:  # 0 until there is something to average
            notify(f"STATUS=real-time factor {factor:.2f}")

    node.create_timer(SUPERVISION_PERIOD_S, check, clock=Clock(clock_type=ClockType.STEADY_TIME))
