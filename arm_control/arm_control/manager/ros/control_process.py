"""Assembles a stand-alone controller manager: description, hardware, manager, loop, services.

At the start it waits for the description, then creates everything in the main thread. At the end it
stops the services, shuts the controllers down on the loop, joins the loop, and only then destroys
the nodes.
"""

import logging
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from math import isnan, nan

from rclpy.executors import Executor, SingleThreadedExecutor
from rclpy.node import Node
from rosgraph_msgs.msg import Clock as ClockMessage

from arm_control.errors import ArmControlError, HardwareInfoError
from arm_control.hardware.info import parse_hardware_info
from arm_control.loop.clock import Clock, MonotonicClock, SystemClock, Throttle
from arm_control.loop.control_loop import ControlLoop
from arm_control.loop.pacer import Pacer
from arm_control.manager.controller_manager import (
    ControlCycle,
    ControllerManager,
    bring_up,
    configured_manager,
)
from arm_control.manager.node_arguments import controller_arguments
from arm_control.manager.registry import create_hardware
from arm_control.manager.ros.controller_manager_node import ControllerManagerNode, DescriptionTopic
from arm_control.manager.ros.controller_manager_server import ControllerManagerServer
from arm_control.manager.ros.controller_node import controllers_executor
from arm_description.errors import DescriptionError
from arm_description.urdf.description import RobotDescription
from arm_node.process import EXIT_FAILED, NodeProcess
from arm_node.qos import NEWEST
from arm_node.workarounds.discovery import first_node

ROUNDING_S = 1e-6


class SimulatedClock:
    """The time that a simulation publishes; see `arm_control.loop.clock.Clock`.

    It has its own hidden node. The manager's node cannot be used: its services block the thread
    that spins it, so time would stand still meanwhile.
    """

    def __init__(self) -> None:
        self._time_s = nan

    def now_s(self) -> float:
        """Return the latest time; NaN before the first message."""
        return self._time_s

    def listen(
        self,
        manager_node: ControllerManagerNode,
        executor: Executor,
        *,
        on_start: Callable[[], object],
        on_advance: Callable[[], object],
        on_set_back: Callable[[], object],
    ) -> Node:
        """Subscribe; return the clock's node, which the caller must destroy.

        Args:
            manager_node: provides the namespace and remaps.
            executor: runs the callbacks.
            on_start: called at the first message.
            on_advance: called at each later message.
            on_set_back: called instead if the time was set back.
        """

        def take(message: ClockMessage) -> None:
            time_s = message.clock.sec + message.clock.nanosec * 1e-9
            last_s, self._time_s = self._time_s, time_s
            if isnan(last_s):
                on_start()
            elif time_s < last_s:
                on_set_back()
            else:
                on_advance()

        node = Node(
            f"_{manager_node.get_name()}_clock",
            namespace=manager_node.get_namespace(),
            cli_args=controller_arguments(manager_node.arguments),
            use_global_arguments=False,
            enable_rosout=False,
            start_parameter_services=False,
        )
        node.create_subscription(ClockMessage, "/clock", take, NEWEST)
        executor.add_node(node)
        return node


class DeadlineClock:
    """A clock slightly ahead of another, so that rounding does not miss a deadline."""

    def __init__(self, clock: Clock) -> None:
        self._clock = clock

    def now_s(self) -> float:
        """Return the other clock's time plus one microsecond."""
        return self._clock.now_s() + ROUNDING_S


LISTENING_S = 0.1
REMINDER_INTERVAL_S = 1.0
LOOP_JOIN_TIMEOUT_S = 5.0
CATCH_UP_PERIODS = 0.75
"""A late cycle is caught up, a missed one is skipped: commands in a burst are of no use."""

logger = logging.getLogger("controller_manager")


@contextmanager
def control_process(process: NodeProcess, arguments: Sequence[str]) -> Iterator[None]:
    """Run a controller manager for the hardware of the first usable description.

    Raises:
        ArmControlError: a parameter is invalid, or hardware did not reach its initial state.
    """
    with ExitStack() as nodes, ExitStack() as ending:
        # Destroying a node while the executor uses it crashes the process.
        ending.callback(process.join_spinning)
        node = first_node(lambda: ControllerManagerNode(arguments))
        executor = ending.enter_context(controllers_executor())
        own = nodes.enter_context(ExitStack())
        own.callback(node.destroy_node)
        descriptions = DescriptionTopic(node)
        found = _wait_for_robot(process, node, descriptions)
        if found is not None:
            description, manager = found
            with ExitStack() as started:
                started.callback(manager.shutdown)
                bring_up(manager, node.settings)
                logger.info("update rate is %d Hz", manager.update_rate_hz)
                loop = _loop(process, node, manager, nodes)
                started.pop_all()
            ending.callback(loop.join, LOOP_JOIN_TIMEOUT_S)
            ending.callback(loop.stop)
            server = ControllerManagerServer(
                node,
                manager,
                loop,
                executor,
                robot_description=description,
                descriptions=descriptions,
            )
            own.pop_all()
            own.callback(server.destroy_nodes)
            ending.callback(server.shutdown)
        yield


def _wait_for_robot(
    process: NodeProcess, node: ControllerManagerNode, descriptions: DescriptionTopic
) -> tuple[RobotDescription, ControllerManager] | None:
    """Return the first usable description and its manager; None if the process must end."""
    description = _description_parameter(node)
    reminder = Throttle(REMINDER_INTERVAL_S)
    reminder.permits()  # The first reminder waits, because the description may be on its way.
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    logger.info("Subscribing to '%s' topic for robot description.", descriptions.name)
    try:
        while not process.stopping:
            if description is not None:
                found = _manager(description, node)
                if found is not None:
                    descriptions.use(description)
                    return found
            elif reminder.permits():
                logger.warning(
                    "Waiting for data on 'robot_description' topic to finish initialization"
                )
            executor.spin_once(timeout_sec=LISTENING_S)
            description = descriptions.take()
        return None
    finally:
        executor.remove_node(node)
        executor.shutdown()


def _description_parameter(node: ControllerManagerNode) -> str | None:
    given = node.given_parameters().get("robot_description")
    if not given:
        return None
    logger.warning(
        "[Deprecated] Passing the robot description parameter directly to the control_manager node "
        "is deprecated. Use the 'robot_description' topic from 'robot_state_publisher' instead."
    )
    return str(given)


def _manager(
    description: str, node: ControllerManagerNode
) -> tuple[RobotDescription, ControllerManager] | None:
    """Create a manager for a description's hardware; log the reason if that fails."""
    try:
        document = RobotDescription(description)
        infos = parse_hardware_info(document)
        if not infos:
            raise HardwareInfoError("it has no <ros2_control> block, which describes the hardware")
        hardware = [create_hardware(info) for info in infos]
        name = node.get_fully_qualified_name()
        return document, configured_manager(hardware, node.settings, document, name)
    except (ArmControlError, DescriptionError) as error:
        logger.error(
            "The robot description cannot be used: %s. Correct it and publish it again.", error
        )
        return None


def _loop(
    process: NodeProcess, node: ControllerManagerNode, manager: ControllerManager, nodes: ExitStack
) -> ControlLoop:
    """Start the loop; with simulation time it is paused until the first /clock message."""
    simulated = SimulatedClock() if node.get_parameter("use_sim_time").value else None
    period_s = 1.0 / manager.update_rate_hz
    pacer = Pacer(
        period_s,
        clock=DeadlineClock(simulated) if simulated else None,
        catch_up_s=CATCH_UP_PERIODS * period_s,
        print_warnings=node.settings.overruns.print_warnings,
    )
    cycle = ControlCycle(manager, simulated or SystemClock(), simulated or MonotonicClock())
    loop = ControlLoop(
        cycle, pacer, on_failure=lambda _: process.stop(EXIT_FAILED), priority=node.loop_priority()
    )
    loop.start(paused=simulated is not None)
    if simulated is not None:
        clock_node = simulated.listen(
            node,
            process.executor,
            on_start=loop.resume,
            on_advance=lambda: loop.call(_wake),
            on_set_back=lambda: loop.call(pacer.restart),
        )
        nodes.callback(clock_node.destroy_node)
    return loop


def _wake() -> None:
    """Do nothing; the call itself wakes the loop, which then reads the clock."""
