"""The ROS half of a running controller manager: services, topics and nodes."""

import logging
from collections.abc import Sequence

from controller_manager_msgs.msg import ControllerManagerActivity
from rclpy.executors import Executor, MultiThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter

from arm_control.errors import ArmControlError, LoopStoppedError
from arm_control.lifecycle import LifecycleState, Transition
from arm_control.loop.control_loop import ControlLoop
from arm_control.manager.controller_manager import ControllerManager
from arm_control.manager.diagnostics import ManagerDiagnostics, RefusedRequests
from arm_control.manager.introspection import ManagerSnapshot
from arm_control.manager.node_arguments import controller_arguments
from arm_control.manager.ros.control_plane import ControlPlane
from arm_control.manager.ros.controller_manager_node import ControllerManagerNode
from arm_control.manager.ros.description_topic import LATCHED_QOS, DescriptionTopic
from arm_control.manager.ros.emergency_stop import EmergencyStopServer
from arm_control.manager.ros.introspection_publisher import IntrospectionPublisher
from arm_control.manager.ros.manager_services import ManagerServices
from arm_control.manager.ros.messages import activity_message
from arm_description.urdf.description import Description, text_of
from arm_node.executor_thread import ExecutorThread
from arm_node.logger_levels import LoggerLevelServices
from arm_node.names import as_node_name


class _ServiceExecutor(MultiThreadedExecutor):
    """An executor whose threads end with it; rclpy's keep running until the process exits."""

    def shutdown(self, timeout_sec: float | None = None) -> bool:
        """Shut down; wait this long for running callbacks, and return whether they returned."""
        is_idle = super().shutdown(timeout_sec)
        self._executor.shutdown(wait=is_idle)
        return is_idle


SERVICE_THREADS = 3
"""One for requests that wait for the control loop, one for requests that only read, and one for the
emergency stop, which waits for neither."""

logger = logging.getLogger("controller_manager")


class ControllerManagerServer:
    """Offers a manager's services on its node until `shutdown`.

    The services run on separate threads, because they wait for the control loop; the nodes of
    controllers and components run on the given executor. At the end, call `shutdown`, join the
    loop, and call `destroy_nodes`.
    """

    def __init__(
        self,
        node: ControllerManagerNode,
        manager: ControllerManager,
        loop: ControlLoop,
        executor: Executor,
        *,
        robot_description: Description = "",
        descriptions: DescriptionTopic | None = None,
    ) -> None:
        """Offer the services.

        Args:
            node: the manager's node, not yet in an executor.
            manager: the core, which belongs to the loop thread.
            loop: runs it; already started, paused or not.
            executor: serves the nodes of controllers and components.
            robot_description: the hardware's URDF.
            descriptions: the node's subscription, if the URDF came from a topic.
        """
        self._node = node
        self._manager = manager
        self._executor = executor
        self._descriptions = descriptions or DescriptionTopic(node, text_of(robot_description))
        self._plane = ControlPlane(
            node,
            manager,
            loop,
            executor,
            robot_description=robot_description,
        )
        self._component_nodes = [
            self._make_component_node(component.name)
            for component in self._plane.on_loop(manager.list_hardware_components)
        ]
        self._loop = loop
        node.add_post_set_parameters_callback(self._parameters_changed)
        self._activity = node.create_publisher(ControllerManagerActivity, "~/activity", LATCHED_QOS)
        self._snapshot = self._plane.on_loop(lambda: ManagerSnapshot(manager))
        self._plane.on_loop(self._observe)
        refusals = RefusedRequests()
        self._services = ManagerServices(node, self._plane, manager, self._snapshot, refusals)
        self._thread = ExecutorThread(
            "controller manager services", _ServiceExecutor(SERVICE_THREADS)
        )
        self._stop = EmergencyStopServer(node, self._thread.executor, loop, [manager])
        self._introspection = IntrospectionPublisher(node, manager, self._snapshot, loop)
        self._introspection.start()
        node.health.watch(ManagerDiagnostics(manager, self._snapshot, loop, refusals))
        # The services wait for the control loop. On the process's own executor they would block
        # every subscription meanwhile. A coroutine would not help, because rclpy's executors do not
        # wake up when another thread completes a future that a coroutine awaits.
        self._thread.executor.add_node(node)
        self._thread.start()

    def start_controllers(self, names: Sequence[str]) -> None:
        """Load, configure and activate controllers like a spawner.

        Raises:
            ArmControlError: one of them cannot be started; the message says why.
        """
        self._plane.start_controllers(names)

    def shutdown(self) -> None:
        """Stop the services; deactivate and finalize controllers and components."""
        self._node.health.stop()
        self._introspection.stop()
        self._thread.stop()
        try:
            self._plane.shutdown()
        except LoopStoppedError:
            # A tick failed and the loop thread has ended, so this thread may use the manager.
            self._manager.shutdown()
        except ArmControlError as error:
            logger.warning("controllers were not shut down: %s", error)

    def destroy_nodes(self) -> None:
        """Destroy the nodes of manager, controllers and components; join the loop first."""
        self._plane.destroy_nodes()
        for node in self._component_nodes:
            self._executor.remove_node(node)
            node.destroy_node()
        self._node.destroy_node()

    def controller_transitioned(
        self, name: str, transition: Transition, start: LifecycleState, end: LifecycleState
    ) -> None:
        """Publish a controller's transition; loop thread."""
        self._plane.publish_transition(name, transition, start, end)

    def activity_changed(self) -> None:
        """Publish the states of controllers and components; loop thread."""
        message = activity_message(
            [status for status, _ in self._snapshot.controllers],
            [status for status, _, _ in self._snapshot.components],
        )
        message.header.stamp = self._node.stamp()
        self._activity.publish(message)

    def _parameters_changed(self, changed: Sequence[Parameter]) -> None:
        """Apply changed parameters to the loop."""
        for parameter in changed:
            if parameter.name == "overruns.print_warnings":
                self._loop.pacer.print_warnings = bool(parameter.value)

    def _observe(self) -> None:
        """Observe the manager's changes; loop thread."""
        # In this order, because the activity message is made from the snapshot.
        for observer in (self._snapshot, self):
            self._manager.add_observer(observer)
            observer.activity_changed()

    def _make_component_node(self, component: str) -> Node:
        node = Node(
            as_node_name(component.lower()),
            namespace=self._node.get_namespace(),
            cli_args=controller_arguments(self._node.arguments, self._node.clock_arguments()),
            use_global_arguments=False,
        )
        self._node.give_clock(node)
        LoggerLevelServices(node)
        self._executor.add_node(node)
        return node
