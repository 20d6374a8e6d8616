"""Puts the simulation together: model, hardware, controller manager, loop, clock, cameras, window.

Start: everything is made while time stands still, then the loop goes. End: the services stop,
the controllers are shut down on the loop, the loop is joined, and only then are nodes destroyed.
"""

import logging
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, closing, contextmanager

from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.node import Node

from arm_control.control_loop import ControlLoop
from arm_control.hardware_info import HardwareInfo, parse_hardware_info
from arm_control.pacer import Pacer
from arm_control.ros.configured_manager import bring_up, configured_manager
from arm_control.ros.controller_manager_node import ControllerManagerNode
from arm_control.ros.controller_manager_server import ControllerManagerServer
from arm_description.urdf import parse_urdf
from arm_gazebo.build_options import BuildOptions
from arm_gazebo.built_model import BuiltModel
from arm_gazebo.camera_feed import CameraFeed
from arm_gazebo.camera_sensor import CameraSensor, parse_cameras
from arm_gazebo.display import check_display
from arm_gazebo.errors import SettingsError
from arm_gazebo.gazebo_tags import parse_gazebo_tags
from arm_gazebo.mesh_cache import cache_folder
from arm_gazebo.model_builder import build_model
from arm_gazebo.physics_timing import PhysicsTiming, physics_timing
from arm_gazebo.ros.clock_publisher import RosClockPublisher
from arm_gazebo.ros.simulation_parameters import SimulationSettings, read_settings
from arm_gazebo.simulated_hardware import SimulatedHardware
from arm_gazebo.simulation import Simulation
from arm_gazebo.simulation_tick import SimulationTick
from arm_gazebo.window_feed import WindowFeed
from arm_node.discovery import answers_held_back
from arm_node.notify import notify
from arm_node.process import EXIT_FAILED, NodeProcess

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
        process.executor.add_node(node)
        settings = read_settings(node)
        manager_node = ControllerManagerNode(arguments)
        nodes.callback(manager_node.destroy_node)
        timing = physics_timing(manager_node.settings.update_rate, settings.physics_step_s)
        hardware_info = _hardware_info(settings)
        sensors = parse_cameras(settings.robot_description)
        built = _build(settings, hardware_info, sensors, timing)
        simulation = Simulation(built, timing, settings.hold_joints)
        hardware = [SimulatedHardware(simulation, info) for info in hardware_info]
        manager = configured_manager(hardware, manager_node.settings, settings.robot_description)
        bring_up(manager, manager_node.settings)
        feeds = [
            ending.enter_context(closing(feed))
            for feed in _feeds(sensors, settings, node.get_namespace())
        ]
        tick = SimulationTick(manager, simulation, RosClockPublisher(node), feeds, timing.period_s)
        pacer = Pacer(
            timing.period_s,
            real_time_factor=settings.real_time_factor,
            print_warnings=manager_node.settings.overruns.print_warnings,
        )
        loop = ControlLoop(tick, pacer, on_failure=lambda _: process.stop(EXIT_FAILED))
        ending.enter_context(_standing_still(loop))
        server = ControllerManagerServer(
            manager_node,
            manager,
            loop,
            process.executor,
            robot_description=settings.robot_description,
        )
        nodes.pop_all()
        nodes.callback(server.destroy_nodes)
        ending.callback(server.shutdown)
        server.start_controllers(settings.spawn)
        loop.resume()
        for feed in feeds:
            feed.start(built.model)
        _supervise(node, pacer, simulation, hardware, feeds)
        yield


@contextmanager
def _standing_still(loop: ControlLoop) -> Iterator[None]:
    """Start the loop, whose time stands still at first; end it and wait for that."""
    loop.start(paused=True)
    try:
        yield
    finally:
        loop.stop()
        loop.join(LOOP_JOIN_TIMEOUT_S)


def _hardware_info(settings: SimulationSettings) -> tuple[HardwareInfo, ...]:
    hardware_info = parse_hardware_info(settings.robot_description)
    if not hardware_info:
        raise SettingsError(
            "the robot description has no <ros2_control> block, so nothing says which joints are "
            "commanded; add one with a <joint> and its interfaces for each"
        )
    return hardware_info


def _build(
    settings: SimulationSettings,
    hardware_info: tuple[HardwareInfo, ...],
    sensors: tuple[CameraSensor, ...],
    timing: PhysicsTiming,
) -> BuiltModel:
    built = build_model(
        parse_urdf(settings.robot_description),
        hardware_info,
        sensors,
        settings.world,
        BuildOptions(
            step_s=timing.step_s,
            base="free" if settings.base == "free" else "fixed",
            spawn=settings.pose,
            self_collide=settings.self_collide,
            strict=settings.strict,
            package_path=settings.package_path,
            mesh_cache=cache_folder(),
        ),
        parse_gazebo_tags(settings.robot_description),
    )
    built.report.log(logger)
    return built


def _feeds(
    sensors: tuple[CameraSensor, ...], settings: SimulationSettings, namespace: str
) -> Iterator[CameraFeed | WindowFeed]:
    """Make what shows the simulation.

    Raises:
        WindowError: a window is asked for where there is no display.
    """
    if not settings.headless:
        check_display()
        yield WindowFeed()
    if sensors:
        ros_arguments = ("-r", f"__ns:={namespace}")
        yield CameraFeed(sensors, settings.render_backend, settings.seed, ros_arguments)


def _supervise(
    node: Node,
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
        for failure in simulation.take_failures():
            logger.error("%s", failure)
        for feed in feeds:
            feed.supervise()
        factor = pacer.statistics.achieved_factor
        if factor:  # 0 until there is something to average
            notify(f"STATUS=real-time factor {factor:.2f}")

    node.create_timer(SUPERVISION_PERIOD_S, look, clock=Clock(clock_type=ClockType.STEADY_TIME))
