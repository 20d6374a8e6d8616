"""Loads, configures, switches and unloads controllers that have a node."""

import logging
import threading
from collections.abc import Callable, Sequence
from concurrent.futures import Future
from concurrent.futures import TimeoutError as FutureTimeoutError
from typing import TypeVar

from rclpy.executors import Executor

from arm_control.controllers.controller import ControllerContext
from arm_control.errors import ArmControlError, ControllerManagerError
from arm_control.lifecycle import LifecycleState, Transition
from arm_control.loop.control_loop import ControlLoop
from arm_control.loop.ros_executor_bridge import run_on_executor
from arm_control.loop.supervision import failure_of
from arm_control.manager.controller_creation import (
    create_controller,
    not_created,
    only_type,
    parameters_of,
)
from arm_control.manager.controller_manager import ControllerManager
from arm_control.manager.loaded_controllers import unknown_controller
from arm_control.manager.node_arguments import controller_arguments, parameter_files
from arm_control.manager.parameter_file import ControllerParameterFile
from arm_control.manager.ros.controller_manager_node import ControllerManagerNode
from arm_control.manager.ros.controller_node import ControllerNode
from arm_control.manager.ros.parameter_node import OF_CONTROLLERS
from arm_control.manager.switch_planner import Strictness, SwitchRequest, SwitchResult
from arm_control.parameters import ParameterSpec
from arm_description.urdf.description import Description

logger = logging.getLogger("controller_manager")

ResultT = TypeVar("ResultT")

LOOP_TIMEOUT_S = 10.0
DEFAULT_SWITCH_TIMEOUT_S = 1.0
START_SWITCH_TIMEOUT_S = 5.0
EXECUTOR_TIMEOUT_S = 1.0


class ControlPlane:
    """The operations behind the manager's services, also for programs that use no services.

    Requests are served one after another. Each method blocks the calling thread until the control
    loop has done its part, paused or not, so do not call them on the loop thread or the thread of
    `executor`. Nodes are created and destroyed on the calling thread.

    Every method except `switch_controller` raises `ArmControlError` with the reason for a refusal.
    """

    def __init__(
        self,
        node: ControllerManagerNode,
        manager: ControllerManager,
        loop: ControlLoop,
        executor: Executor,
        *,
        robot_description: Description,
    ) -> None:
        """Take ownership of the manager's controllers.

        The parameters of `node` hold their types and files; `executor` serves their nodes.
        """
        self._node = node
        self._manager = manager
        self._loop = loop
        self._executor = executor
        self._robot_description = robot_description
        self._lock = threading.RLock()
        self._nodes: dict[str, ControllerNode] = {}

    def load_controller(self, name: str) -> None:
        """Create a controller and its node; the manager's parameter `<name>.type` is its type.

        Without that parameter, the type comes from the controller's own entry in a parameter file
        of this process, as in the spawner.
        """
        with self._lock:
            if name in self._nodes:
                raise ControllerManagerError(
                    f"A controller named '{name}' was already loaded inside the controller manager"
                )
            if name == self._node.get_name():
                # With two nodes of the same name, clients could reach the parameters of neither.
                raise ControllerManagerError(
                    f"a controller cannot have the controller manager's name '{name}'"
                )
            types = self._node.strings(f"{name}.type") or self._own_type(name)
            type_name = only_type(name, types, self._node.get_parameters_by_prefix(""))
            self._node.declare_specs(_controller_specs(name))
            fallbacks = self._node.strings(f"{name}.fallback_controllers")
            node = self._make_node(name, type_name)
            self._nodes[name] = node
            try:
                self.on_loop(
                    lambda: self._manager.load_controller(node.controller, type_name, fallbacks)
                )
            except ArmControlError:
                self._forget(name)
                raise
            self._executor.add_node(node)

    def configure_controller(self, name: str) -> None:
        """Read the controller's parameters again, configure it, and create its end points."""
        with self._lock:
            node = self._find(name, "configure")
            with parameters_of(name):
                parameters, rate_hz = node.read_controller_parameters()
            if self._state_of(name) in (LifecycleState.UNCONFIGURED, LifecycleState.INACTIVE):
                # A controller that failed to deactivate is unconfigured, but its end points still
                # exist.
                self.cleanup_controller(name)
            self.on_loop(lambda: self._manager.configure_controller(name, parameters, rate_hz))
            reason = failure_of(
                lambda: node.on_configure(parameters), f"creating the topics of controller '{name}'"
            )
            reason = reason or node.take_late_changes()
            if reason:
                self.cleanup_controller(name)
                raise ControllerManagerError(f"controller '{name}' was not configured: {reason}")

    def cleanup_controller(self, name: str) -> None:
        """Return a controller to unconfigured."""
        with self._lock:
            node = self._find(name, "clean up")
            self.on_loop(lambda: self._manager.cleanup_controller(name))
            node.on_cleanup()

    def unload_controller(self, name: str) -> None:
        """Destroy an inactive or unconfigured controller and its node."""
        with self._lock:
            node = self._find(name, "unload")
            self.on_loop(lambda: self._manager.unload_controller(name))
            node.on_cleanup()
            run_on_executor(self._executor, lambda: self._forget(name))
            self._wait_for_executor()

    def unload_all(self, *, force: bool) -> None:
        """Unload every controller; active ones only with `force`."""
        with self._lock:
            statuses = self.on_loop(self._manager.list_controllers)
            active = tuple(s.name for s in statuses if s.state is LifecycleState.ACTIVE)
            if active and not force:
                raise ControllerManagerError(
                    f"controllers are still active: {', '.join(active)}; deactivate them first"
                )
            self.switch_controller(SwitchRequest(deactivate=active))
            for status in statuses:
                self.unload_controller(status.name)

    def switch_controller(
        self, request: SwitchRequest, timeout_s: float = DEFAULT_SWITCH_TIMEOUT_S
    ) -> SwitchResult:
        """Deactivate and activate controllers in one step.

        `timeout_s` is how long to wait for the loop to start it, in wall time; 0 for the default.
        """
        timeout_s = timeout_s or DEFAULT_SWITCH_TIMEOUT_S
        with self._lock:
            future = self._loop.call(lambda: self._manager.switch_controller(request))
            try:
                return self._result(future, timeout_s)
            except FutureTimeoutError:
                message = f"Switch controller timed out after {timeout_s:g} seconds!"
            except ArmControlError as error:
                message = str(error)
        logger.error("%s", message)
        return SwitchResult(False, message)

    def start_controllers(self, names: Sequence[str]) -> None:
        """Load, configure and activate controllers one by one, like a spawner."""
        for name in names:
            self.load_controller(name)
            logger.info("Loaded %s", name)
            self.configure_controller(name)
            result = self.switch_controller(
                SwitchRequest(activate=(name,), strictness=Strictness.STRICT),
                START_SWITCH_TIMEOUT_S,
            )
            if not result.ok:
                raise ControllerManagerError(result.message)
            logger.info("Configured and activated %s", name)

    def shutdown(self) -> None:
        """Deactivate and finalize everything; keep the nodes until the loop is joined."""
        with self._lock:
            self.on_loop(self._manager.shutdown)

    def destroy_nodes(self) -> None:
        """Destroy the controllers' nodes; the loop must have ended."""
        with self._lock:
            for name in list(self._nodes):
                self._forget(name)

    def publish_transition(
        self, name: str, transition: Transition, start: LifecycleState, end: LifecycleState
    ) -> None:
        """Publish a transition of a controller; loop thread."""
        node = self._nodes.get(name)
        if node is not None:
            node.publish_transition(transition, start, end)

    def on_loop(self, function: Callable[[], ResultT]) -> ResultT:
        """Run a function on the loop thread and return its result.

        Raises:
            ControllerManagerError: the loop did not start it in time.
        """
        try:
            return self._result(self._loop.call(function), LOOP_TIMEOUT_S)
        except FutureTimeoutError:
            raise ControllerManagerError(
                f"the control loop did not handle the request within {LOOP_TIMEOUT_S:g} s"
            ) from None

    @staticmethod
    def _result(future: "Future[ResultT]", timeout_s: float) -> ResultT:
        try:
            return future.result(timeout_s)
        except FutureTimeoutError:
            if future.cancel():
                raise
            # The loop has already started it, so it cannot be cancelled and will end soon.
            return future.result(LOOP_TIMEOUT_S)

    def _own_type(self, name: str) -> tuple[str, ...]:
        """Return the type in the controller's own entry of a parameter file, if any."""
        files = [*self._node.strings(f"{name}.params_file"), *parameter_files(self._node.arguments)]
        namespace = self._node.get_namespace()
        for path in files:
            if own := ControllerParameterFile(path).own_type(name, namespace):
                return own
        return ()

    def _make_node(self, name: str, type_name: str) -> ControllerNode:
        arguments = controller_arguments(
            self._node.arguments,
            [
                # The manager's clock, however the manager got that setting.
                *self._node.clock_arguments(),
                *self._node.strings(f"{name}.node_options_args"),
                *(
                    argument
                    for file in self._node.strings(f"{name}.params_file")
                    for argument in ("--params-file", file)
                ),
            ],
        )
        context = ControllerContext.of(name, self._manager.update_rate_hz, self._robot_description)
        controller = create_controller(type_name, context)
        try:
            with parameters_of(name):
                return ControllerNode(
                    controller,
                    type_name,
                    self._node.get_namespace(),
                    arguments,
                    self._loop,
                    self._node.give_clock,
                )
        except ArmControlError:
            raise
        except Exception as error:
            # An adapter may raise anything, and rcl has an exception for each bad argument.
            # Only the author of a controller needs the traceback.
            if not type(error).__module__.startswith("rclpy"):
                logger.exception("controller '%s' cannot be created", name)
            raise not_created(name, error) from error

    def _state_of(self, name: str) -> LifecycleState:
        statuses = self.on_loop(self._manager.list_controllers)
        return next(status.state for status in statuses if status.name == name)

    def _find(self, name: str, action: str) -> ControllerNode:
        node = self._nodes.get(name)
        if node is None:
            loaded = ", ".join(self._nodes) or "none"
            raise ControllerManagerError(f"{unknown_controller(name, action)}; loaded: {loaded}")
        return node

    def _wait_for_executor(self) -> None:
        """Wait for one pass of the executor, which until then keeps a destroyed node alive."""
        passed = threading.Event()
        self._executor.create_task(passed.set)
        passed.wait(EXECUTOR_TIMEOUT_S)

    def _forget(self, name: str) -> None:
        node = self._nodes.pop(name)
        node.on_cleanup()
        self._executor.remove_node(node)
        node.destroy_node()


def _controller_specs(name: str) -> tuple[ParameterSpec, ...]:
    """Return the manager's parameters for one controller."""
    return tuple(
        ParameterSpec(f"{name}.{parameter}", str, True, (), description, read_only=False)
        for parameter, description in OF_CONTROLLERS.items()
        if parameter in ("fallback_controllers", "node_options_args")
    )
