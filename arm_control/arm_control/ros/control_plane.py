"""Loads, configures, switches and unloads controllers that have a node."""

import logging
import threading
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future
from concurrent.futures import TimeoutError as FutureTimeoutError
from contextlib import contextmanager
from typing import TypeVar

from rclpy.executors import Executor

from arm_control.control_loop import ControlLoop
from arm_control.controller import ControllerContext
from arm_control.controller_manager import ControllerManager
from arm_control.controller_switch import Strictness, SwitchRequest, SwitchResult
from arm_control.errors import ArmControlError, ControllerManagerError, ParameterError
from arm_control.guarded import failure_of
from arm_control.lifecycle import LifecycleState, Transition
from arm_control.parameters import ParameterSpec
from arm_control.registry import controller_class
from arm_control.ros.controller_manager_node import ControllerManagerNode
from arm_control.ros.controller_node import ControllerNode
from arm_control.ros.executor_bridge import run_on_executor
from arm_control.ros.node_arguments import controller_arguments
from arm_node.process import first_line

logger = logging.getLogger(__name__)

ResultT = TypeVar("ResultT")

LOOP_TIMEOUT_S = 10.0
DEFAULT_SWITCH_TIMEOUT_S = 1.0
START_SWITCH_TIMEOUT_S = 5.0
EXECUTOR_TIMEOUT_S = 1.0

USE_SIM_TIME = ("--param", "use_sim_time:=true")
"""A controller goes by the manager's clock, wherever the manager was told of it."""


class ControlPlane:
    """What the manager's services do, and what a program may do without services.

    Requests are served one after another. Each method blocks the thread that calls it until the
    control loop has done its part, paused or not, so call none of them on the loop thread or on
    the thread of `executor`. Nodes are made and destroyed on the calling thread.

    Every method but `switch_controller` raises `ArmControlError` with the reason for a refusal.
    """

    def __init__(
        self,
        node: ControllerManagerNode,
        manager: ControllerManager,
        loop: ControlLoop,
        executor: Executor,
        *,
        robot_description: str,
    ) -> None:
        """Take charge of the manager's controllers.

        Args:
            node: the manager's; its parameters tell types and files of controllers.
            manager: the core, which belongs to the loop thread.
            loop: the loop that runs it.
            executor: serves the nodes of the controllers.
            robot_description: URDF for the controllers.
        """
        self._node = node
        self._manager = manager
        self._loop = loop
        self._executor = executor
        self._robot_description = robot_description
        self._lock = threading.RLock()
        self._nodes: dict[str, ControllerNode] = {}

    def load_controller(self, name: str) -> None:
        """Make a controller and its node; the manager's parameter `<name>.type` says what."""
        with self._lock:
            if name in self._nodes:
                raise ControllerManagerError(
                    f"A controller named '{name}' was already loaded inside the controller manager"
                )
            if name == self._node.get_name():
                # Of two such nodes neither's parameters could be reached.
                raise ControllerManagerError(
                    f"no controller can be named '{name}', as the controller manager itself is"
                )
            types = self._node.strings(f"{name}.type")
            if len(types) != 1:
                raise ControllerManagerError(f"The 'type' param was not defined for '{name}'.")
            type_name = types[0]
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
        """Read the controller's parameters anew, configure it, and make its end points."""
        with self._lock:
            node = self._find(name, "configure")
            with _parameters_of(name):
                parameters, rate_hz = node.read_controller_parameters()
            if self._state_of(name) in (LifecycleState.UNCONFIGURED, LifecycleState.INACTIVE):
                # One that could not stop is unconfigured, but its end points are still there.
                self.cleanup_controller(name)
            self.on_loop(lambda: self._manager.configure_controller(name, parameters, rate_hz))
            reason = failure_of(
                lambda: node.on_configure(parameters), f"making the topics of controller '{name}'"
            )
            reason = reason or node.take_late_changes()
            if reason:
                self.cleanup_controller(name)
                raise ControllerManagerError(f"controller '{name}' was not configured: {reason}")

    def cleanup_controller(self, name: str) -> None:
        """Take a controller back to unconfigured."""
        with self._lock:
            node = self._find(name, "clean up")
            self.on_loop(lambda: self._manager.cleanup_controller(name))
            node.on_cleanup()

    def unload_controller(self, name: str) -> None:
        """Destroy a controller that is not active, and its node."""
        with self._lock:
            node = self._find(name, "unload")
            self.on_loop(lambda: self._manager.unload_controller(name))
            node.on_cleanup()
            run_on_executor(self._executor, lambda: self._forget(name))
            self._wait_for_executor()

    def unload_all(self, *, force: bool) -> None:
        """Unload every controller, to begin anew; active ones only by force."""
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
        """Deactivate and activate controllers in one go.

        Args:
            request: the controllers.
            timeout_s: how long the loop may take to get to it, in wall time; 0 for the default.
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
        """Load, configure and activate controllers one by one, as a spawner would."""
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
        """Deactivate and finalize everything; the nodes stay until the loop is joined."""
        with self._lock:
            self.on_loop(self._manager.shutdown)

    def destroy_nodes(self) -> None:
        """Destroy the controllers' nodes; the loop must run no more."""
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
            ControllerManagerError: the loop did not get to it in time.
        """
        try:
            return self._result(self._loop.call(function), LOOP_TIMEOUT_S)
        except FutureTimeoutError:
            raise ControllerManagerError(
                f"the control loop did not get to the request within {LOOP_TIMEOUT_S:g} s"
            ) from None

    @staticmethod
    def _result(future: "Future[ResultT]", timeout_s: float) -> ResultT:
        try:
            return future.result(timeout_s)
        except FutureTimeoutError:
            if future.cancel():
                raise
            # The loop has begun with it: it is too late to call it off, and it ends soon.
            return future.result(LOOP_TIMEOUT_S)

    def _make_node(self, name: str, type_name: str) -> ControllerNode:
        arguments = controller_arguments(
            self._node.arguments,
            [
                *(USE_SIM_TIME if self._node.get_parameter("use_sim_time").value else ()),
                *self._node.strings(f"{name}.node_options_args"),
                *(
                    argument
                    for file in self._node.strings(f"{name}.params_file")
                    for argument in ("--params-file", file)
                ),
            ],
        )
        context = ControllerContext(name, self._manager.update_rate_hz, self._robot_description)
        try:
            controller = controller_class(type_name)(context)
            with _parameters_of(name):
                return ControllerNode(
                    controller, type_name, self._node.get_namespace(), arguments, self._loop
                )
        except ArmControlError:
            raise
        except Exception as error:
            # Anybody's constructor, and rcl, which raises a type for every argument it dislikes.
            # The former's author needs a traceback; who gave the arguments needs a sentence.
            if not type(error).__module__.startswith("rclpy"):
                logger.exception("controller '%s' cannot be made", name)
            raise ControllerManagerError(
                f"controller '{name}' cannot be made: {type(error).__name__}: {first_line(error)}"
            ) from error

    def _state_of(self, name: str) -> LifecycleState:
        statuses = self.on_loop(self._manager.list_controllers)
        return next(status.state for status in statuses if status.name == name)

    def _find(self, name: str, action: str) -> ControllerNode:
        node = self._nodes.get(name)
        if node is None:
            raise ControllerManagerError(
                f"Could not {action} controller with name '{name}' because no controller with "
                f"this name exists; loaded: {', '.join(self._nodes) or 'none'}"
            )
        return node

    def _wait_for_executor(self) -> None:
        """Let the executor pass once: until then it keeps a destroyed node in the graph."""
        passed = threading.Event()
        self._executor.create_task(passed.set)
        passed.wait(EXECUTOR_TIMEOUT_S)

    def _forget(self, name: str) -> None:
        node = self._nodes.pop(name)
        node.on_cleanup()
        self._executor.remove_node(node)
        node.destroy_node()


@contextmanager
def _parameters_of(name: str) -> Iterator[None]:
    """Say in errors about parameters whose they are."""
    try:
        yield
    except ParameterError as error:
        raise ParameterError(f"controller '{name}': {error}") from error


def _controller_specs(name: str) -> tuple[ParameterSpec, ...]:
    """Return the manager's parameters about one controller."""
    return tuple(
        ParameterSpec(f"{name}.{parameter}", str, True, (), description, read_only=False)
        for parameter, description in (
            ("fallback_controllers", "Controllers to activate where an update of this one fails"),
            ("node_options_args", "ROS arguments for the controller's node"),
        )
    )
