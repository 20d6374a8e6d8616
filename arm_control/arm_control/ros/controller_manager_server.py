"""The ROS side of a running controller manager: services, topics, nodes of what it manages."""

import logging
from collections.abc import Sequence

from controller_manager_msgs.msg import ControllerManagerActivity
from rclpy.executors import Executor
from rclpy.node import Node
from rclpy.parameter import Parameter

from arm_control.control_loop import ControlLoop
from arm_control.controller_manager import ControllerManager
from arm_control.errors import ArmControlError, LoopStoppedError
from arm_control.lifecycle import LifecycleState, Transition
from arm_control.manager_diagnostics import ManagerDiagnostics
from arm_control.manager_snapshot import ManagerSnapshot
from arm_control.refusals import Refusals
from arm_control.ros.control_plane import ControlPlane
from arm_control.ros.controller_manager_node import ControllerManagerNode
from arm_control.ros.convert import activity_message
from arm_control.ros.description_topic import LATCHED_QOS, DescriptionTopic
from arm_control.ros.manager_services import ManagerServices
from arm_control.ros.node_arguments import controller_arguments
from arm_control.ros.node_name import as_node_name
from arm_control.ros.service_executor import ServiceExecutor
from arm_node.executor_thread import ExecutorThread

SERVICE_THREADS = 2
"""One for what waits for the control loop, one for what only looks."""

logger = logging.getLogger(__name__)


class ControllerManagerServer:
    """Serves a manager on its node, from its making until `shutdown`.

    The services run on threads of their own, because they wait for the control loop; the nodes
    of controllers and components run on the executor given. In the end: `shutdown`, join the
    loop, `destroy_nodes`.
    """

    def __init__(
        self,
        node: ControllerManagerNode,
        manager: ControllerManager,
        loop: ControlLoop,
        executor: Executor,
        *,
        robot_description: str = "",
        descriptions: DescriptionTopic | None = None,
    ) -> None:
        """Offer the services.

        Args:
            node: the manager's node; in no executor yet.
            manager: the core, which belongs to the loop thread.
            loop: runs it; started already, paused or not.
            executor: serves the nodes of controllers and components.
            robot_description: the URDF that the hardware was made from.
            descriptions: the node's subscription, where the URDF came that way.
        """
        self._node = node
        self._manager = manager
        self._executor = executor
        self._descriptions = descriptions or DescriptionTopic(node, robot_description)
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
        refusals = Refusals()
        self._services = ManagerServices(node, self._plane, manager, self._snapshot, refusals)
        node.health.watch(ManagerDiagnostics(manager, self._snapshot, loop, refusals))
        # The services wait for the control loop. On the process's own executor they would hold up
        # every subscription meanwhile; a coroutine would not help, because rclpy's executors sleep
        # on while a future that a coroutine awaits is completed elsewhere.
        self._thread = ExecutorThread(
            "controller manager services", ServiceExecutor(SERVICE_THREADS)
        )
        self._thread.executor.add_node(node)
        self._thread.start()

    def start_controllers(self, names: Sequence[str]) -> None:
        """Load, configure and activate controllers as a spawner would, without one.

        Raises:
            ArmControlError: one of them cannot be started; the message says why.
        """
        self._plane.start_controllers(names)

    def shutdown(self) -> None:
        """Serve no more; deactivate and finalize controllers and components."""
        self._node.health.stop()
        self._thread.stop()
        try:
            self._plane.shutdown()
        except LoopStoppedError:
            # A tick failed. The manager belongs to no other thread any more.
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
        """Publish who is in which state; loop thread."""
        message = activity_message(
            [status for status, _ in self._snapshot.controllers],
            [status for status, _, _ in self._snapshot.components],
        )
        message.header.stamp = self._node.stamp()
        self._activity.publish(message)

    def _parameters_changed(self, changed: Sequence[Parameter]) -> None:
        """Bring those into force that the loop was told when it was made."""
        for parameter in changed:
            if parameter.name == "overruns.print_warnings":
                self._loop.pacer.print_warnings = bool(parameter.value)

    def _observe(self) -> None:
        """Follow the manager's changes; loop thread."""
        # In this order: what is published is read off the snapshot.
        for observer in (self._snapshot, self):
            self._manager.add_observer(observer)
            observer.activity_changed()

    def _make_component_node(self, component: str) -> Node:
        node = Node(
            as_node_name(component.lower()),
            namespace=self._node.get_namespace(),
            cli_args=controller_arguments(self._node.arguments),
            use_global_arguments=False,
        )
        self._executor.add_node(node)
        return node
