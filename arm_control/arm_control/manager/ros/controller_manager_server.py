"""The ROS half of a running controller manager: services, topics and nodes."""

import logging
from collections.abc import Callable, Sequence
from typing import Any

from controller_manager_msgs.msg import ControllerManagerActivity
from controller_manager_msgs.srv import (
    CleanupController,
    ConfigureController,
    ListControllers,
    ListControllerTypes,
    ListHardwareComponents,
    ListHardwareInterfaces,
    LoadController,
    ReloadControllerLibraries,
    SetHardwareComponentState,
    SwitchController,
    UnloadController,
)
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
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
from arm_control.manager.registry import controller_types, is_chainable
from arm_control.manager.ros.control_plane import ControlPlane
from arm_control.manager.ros.controller_manager_node import (
    ControllerManagerNode,
    DescriptionTopic,
)
from arm_control.manager.ros.emergency_stop import EmergencyStopServer
from arm_control.manager.ros.introspection_publisher import IntrospectionPublisher
from arm_control.manager.ros.messages import (
    activity_message,
    component_message,
    controller_message,
    interface_message,
    state_message,
)
from arm_control.manager.switch_planner import Strictness, SwitchRequest
from arm_description.urdf.description import Description, text_of
from arm_node.executor_thread import ExecutorThread
from arm_node.names import as_node_name
from arm_node.qos import LATCHED, SERVICE_QOS
from arm_node.ros_logging import LoggerLevelServices

logger = logging.getLogger("controller_manager")

SERVICE_THREADS = 3
"""One for requests that wait for the control loop, one for requests that only read, and one for the
emergency stop, which waits for neither."""
CONTROLLER_INTERFACE = "controller_interface::ControllerInterface"
CHAINABLE_INTERFACE = "controller_interface::ChainableControllerInterface"


class ManagerServices:
    """Creates the services on a node and answers them.

    Requests that change something are served one after another; each may block a thread of the
    node's executor until the control loop has done its part. Lists are answered meanwhile.
    """

    def __init__(
        self,
        node: ControllerManagerNode,
        plane: ControlPlane,
        manager: ControllerManager,
        snapshot: ManagerSnapshot,
        refusals: RefusedRequests,
    ) -> None:
        self._node = node
        self._plane = plane
        self._manager = manager
        self._snapshot = snapshot
        self._refusals = refusals
        reading, changing = MutuallyExclusiveCallbackGroup(), MutuallyExclusiveCallbackGroup()
        for type_, name, answer in (
            (ListControllers, "list_controllers", self._list_controllers),
            (ListControllerTypes, "list_controller_types", self._list_controller_types),
            (LoadController, "load_controller", self._by_name(plane.load_controller)),
            (
                ConfigureController,
                "configure_controller",
                self._by_name(plane.configure_controller),
            ),
            (CleanupController, "cleanup_controller", self._by_name(plane.cleanup_controller)),
            (UnloadController, "unload_controller", self._by_name(plane.unload_controller)),
            (SwitchController, "switch_controller", self._switch_controller),
            (ReloadControllerLibraries, "reload_controller_libraries", self._reload),
            (ListHardwareInterfaces, "list_hardware_interfaces", self._list_interfaces),
            (ListHardwareComponents, "list_hardware_components", self._list_components),
            (SetHardwareComponentState, "set_hardware_component_state", self._set_component_state),
        ):
            node.create_service(
                type_,
                f"~/{name}",
                answer,
                qos_profile=SERVICE_QOS,
                callback_group=reading if name.startswith("list_") else changing,
            )

    def _by_name(self, action: Callable[[str], None]) -> Callable[[Any, Any], Any]:
        """Return the callback of a service whose request is a name and whose response is `ok`."""

        def answer(request: Any, response: Any) -> Any:
            response.ok = self._succeeded(
                action.__name__, request.name, lambda: action(request.name)
            )
            return response

        return answer

    def _succeeded(self, request: str, name: str, action: Callable[[], object]) -> bool:
        """Carry out a request and return whether it succeeded; record why it was refused."""
        try:
            action()
        except ArmControlError as error:
            logger.error("%s", error)
            self._refusals.note(request, name, str(error))
            return False
        self._refusals.clear(request, name)
        return True

    def _list_controllers(
        self, _request: ListControllers.Request, response: ListControllers.Response
    ) -> ListControllers.Response:
        response.controller = [controller_message(s) for s, _ in self._snapshot.controllers]
        return response

    def _list_controller_types(
        self, _request: ListControllerTypes.Request, response: ListControllerTypes.Response
    ) -> ListControllerTypes.Response:
        # Controllers that are not chainable come first, as in ros2_control.
        types = sorted((is_chainable(name), name) for name in controller_types())
        response.types = [name for _, name in types]
        response.base_classes = [
            CHAINABLE_INTERFACE if chainable else CONTROLLER_INTERFACE for chainable, _ in types
        ]
        return response

    def _switch_controller(
        self, request: SwitchController.Request, response: SwitchController.Response
    ) -> SwitchController.Response:
        try:
            strictness = self._strictness(request.strictness)
        except ValueError:
            response.ok = False
            response.message = f"unknown strictness {request.strictness}; it is 1, 2, 3 or 4"
            return response
        # activate_asap has no effect: a switch is completed between two cycles, which is as soon as
        # possible.
        result = self._plane.switch_controller(
            SwitchRequest(
                tuple(request.activate_controllers),
                tuple(request.deactivate_controllers),
                strictness,
            ),
            request.timeout.sec + request.timeout.nanosec * 1e-9,
        )
        response.ok, response.message = result.ok, result.message
        if result.ok:
            self._refusals.clear("switch_controller", "")
        else:
            self._refusals.note("switch_controller", "", result.message)
        return response

    def _reload(
        self,
        request: ReloadControllerLibraries.Request,
        response: ReloadControllerLibraries.Response,
    ) -> ReloadControllerLibraries.Response:
        response.ok = self._succeeded(
            "reload_controller_libraries",
            "",
            lambda: self._plane.unload_all(force=request.force_kill),
        )
        return response

    def _list_interfaces(
        self, _request: ListHardwareInterfaces.Request, response: ListHardwareInterfaces.Response
    ) -> ListHardwareInterfaces.Response:
        commands, states = self._snapshot.interfaces
        response.command_interfaces = [interface_message(status) for status in commands]
        response.state_interfaces = [interface_message(status) for status in states]
        return response

    def _list_components(
        self, _request: ListHardwareComponents.Request, response: ListHardwareComponents.Response
    ) -> ListHardwareComponents.Response:
        response.component = [component_message(s) for s, _, _ in self._snapshot.components]
        return response

    def _set_component_state(
        self,
        request: SetHardwareComponentState.Request,
        response: SetHardwareComponentState.Response,
    ) -> SetHardwareComponentState.Response:
        target = request.target_state

        def set_state() -> None:
            state = _target_state(target.id, target.label)
            self._plane.on_loop(
                lambda: self._manager.set_hardware_component_state(request.name, state)
            )

        response.ok = self._succeeded("set_hardware_component_state", request.name, set_state)
        for status, _, _ in self._snapshot.components:
            if status.name == request.name:
                response.state = state_message(status.state)
        return response

    def _strictness(self, number: int) -> Strictness:
        if number == 0:
            return self._node.default_strictness()
        strictness = Strictness(number)
        if strictness in (Strictness.AUTO, Strictness.FORCE_AUTO):
            logger.warning("strictness %s is treated as BEST_EFFORT", strictness.name)
        return strictness


def _target_state(state_id: int, label: str) -> LifecycleState:
    """Return the state with an id or, if the id is 0, with a label.

    Raises:
        ArmControlError: there is no such primary state.
    """
    for state in LifecycleState:
        if state_id == state or (state_id == 0 and label == state.label):
            return state
    raise ArmControlError(
        f"no hardware state has id {state_id} and label '{label}'; "
        f"the states are {', '.join(f'{state.label} ({state.value})' for state in LifecycleState)}"
    )


class _ServiceExecutor(MultiThreadedExecutor):
    """An executor whose threads end with it; rclpy's keep running until the process exits."""

    def shutdown(self, timeout_sec: float | None = None) -> bool:
        """Shut down; wait this long for running callbacks, and return whether they returned."""
        is_idle = super().shutdown(timeout_sec)
        self._executor.shutdown(wait=is_idle)
        return is_idle


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

        The node is not in an executor yet, and the loop has been started, paused or not. The
        executor serves the nodes of controllers and components. `descriptions` is the node's
        subscription, if the URDF came from a topic.
        """
        self._node = node
        self._manager = manager
        self._executor = executor
        self._descriptions = descriptions or DescriptionTopic(node, text_of(robot_description))
        self._plane = ControlPlane(
            node, manager, loop, executor, robot_description=robot_description
        )
        self._component_nodes = [
            self._make_component_node(component.name)
            for component in self._plane.on_loop(manager.list_hardware_components)
        ]
        self._loop = loop
        node.add_post_set_parameters_callback(self._parameters_changed)
        self._activity = node.create_publisher(ControllerManagerActivity, "~/activity", LATCHED)
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
