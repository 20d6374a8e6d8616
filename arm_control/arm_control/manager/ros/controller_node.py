"""The node of one controller: parameters, adapter, transition events; and its executor."""

import logging
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import TimeoutError as FutureTimeoutError
from contextlib import contextmanager
from inspect import iscoroutinefunction
from typing import Any

from lifecycle_msgs.msg import TransitionEvent
from rcl_interfaces.msg import SetParametersResult
from rclpy.executors import Executor
from rclpy.experimental.events_executor import EventsExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import QoSProfile

from arm_control.controllers.controller import Controller
from arm_control.controllers.ros_adapter import ControllerAdapter
from arm_control.errors import ControllerError, LoopStoppedError, ParameterError
from arm_control.lifecycle import LifecycleState, Transition
from arm_control.loop.control_loop import ControlLoop
from arm_control.loop.supervision import failure_of
from arm_control.manager.controller_creation import general_specs, requested_rate_hz
from arm_control.manager.registry import load_object
from arm_control.manager.ros.messages import transition_events
from arm_control.manager.ros.parameter_node import ParameterNode
from arm_control.manager.settings import ManagerSettings
from arm_control.parameters import specs_of
from arm_node.executor_thread import ExecutorThread
from arm_node.ros_logging import LoggerLevelServices

LONGEST_WAIT_S = 1.0
"""Without a timeout, spin_once of the event-driven executor polls the clock and holds the GIL."""


@contextmanager
def controllers_executor() -> Iterator[Executor]:
    """Spin an event-driven executor in a thread until the end of `with`.

    For each message rclpy's usual executor looks at all nodes that it has. With the event-driven
    one, the simulation of an arm that is commanded at 100 Hz takes half of the processor time, and
    that of 4 arms a third; a command to one of 16 arms moves it after half of the time.
    """
    thread = ExecutorThread("controllers", EventsExecutor(), LONGEST_WAIT_S)
    thread.start()
    try:
        yield thread.executor
    finally:
        thread.stop()


def check_callbacks(node: Node) -> None:
    """Check that the executor can run the callbacks of a node.

    rclpy's event-driven executor would answer a request with the coroutine itself.

    Raises:
        ControllerError: a callback is a coroutine function.
    """
    named = [(f"service {service.srv_name}", service.callback) for service in node.services]
    named += [(f"topic {each.topic_name}", each.callback) for each in node.subscriptions]
    named += [("a timer", timer.callback) for timer in node.timers]
    for what, callback in named:
        if iscoroutinefunction(callback):
            raise ControllerError(
                f"the callback of {what} is a coroutine, which is never run; use a plain function"
            )


EVENT_DEPTH = 10
LOOP_TIMEOUT_S = 1.0
LATER = "it takes effect when the controller is configured again"


class ControllerNode(ParameterNode):
    """A plain node named after its controller, in the manager's namespace.

    Like a real controller's node, it has no life-cycle services. It is created and destroyed on a
    control-plane thread. Only `publish_transition` runs on the loop thread; it must be called for
    every transition, because parameter changes go to the controller while it is configured.
    """

    def __init__(
        self,
        controller: Controller[Any],
        type_name: str,
        namespace: str,
        arguments: Sequence[str],
        loop: ControlLoop,
        give_clock: Callable[[Node], None],
    ) -> None:
        """Make the node and declare the parameters.

        The namespace and the clock are the manager's; the ROS arguments are for this node only.

        Raises:
            ParameterError: a given parameter has the wrong type.
            RegistryError: the controller's adapter cannot be imported.
        """
        super().__init__(
            controller.name,
            namespace=namespace,
            cli_args=list(arguments),
            use_global_arguments=False,
        )
        give_clock(self)
        LoggerLevelServices(self)
        self.controller = controller
        self._loop = loop
        self._is_configured = False
        self._values_taken: Mapping[str, Any] = {}
        self._specs = controller.parameter_specs(self.given_parameters())
        general = general_specs(controller.context.update_rate_hz)
        self.declare_specs((*self._specs, *general))
        self.warn_of_unknown(
            [spec.name for spec in (*self._specs, *general)],
            type_name,
            # Parameters that are given without a node name go to every node of the process.
            others=[spec.name for spec in specs_of(ManagerSettings)],
        )
        self._adapter = self._make_adapter()
        self._events = self.create_publisher(
            TransitionEvent, "~/transition_event", QoSProfile(depth=EVENT_DEPTH)
        )
        self.add_on_set_parameters_callback(self._change_parameters)
        self.add_post_set_parameters_callback(self._parameters_stored)

    def set_parameters_atomically(self, parameter_list: list[Parameter]) -> SetParametersResult:
        """Set parameters; the reason says if one takes effect only at the next configuration."""
        result = super().set_parameters_atomically(parameter_list)
        later = {spec.name for spec in self._specs if spec.at_configuration}
        waits = not later.isdisjoint(item.name for item in parameter_list)
        if result.successful and self._is_configured and waits:
            result.reason = LATER
        return result

    def read_controller_parameters(self) -> tuple[Any, int]:
        """Return the controller's current parameters and its requested update rate.

        Raises:
            ParameterError: a value is invalid.
        """
        self._values_taken = self.values_of(self._specs)
        parameters = self.controller.build_parameters(self._values_taken)
        general = self.values_of(general_specs(self.controller.context.update_rate_hz))
        return parameters, requested_rate_hz(self.get_name(), general)

    def on_configure(self, parameters: Any) -> None:
        """Create the controller's end points.

        Raises:
            ControllerError: a callback is a coroutine function.
        """
        if self._adapter is not None:
            self._adapter.on_configure(parameters)
            check_callbacks(self)

    def take_late_changes(self) -> str:
        """Apply parameters that were set since they were last read; return why that fails."""
        values = self._in_force(self.values_of(self._specs))
        return self._take(values) if values != self._values_taken else ""

    def on_cleanup(self) -> None:
        """Destroy the controller's end points."""
        if self._adapter is not None:
            self._adapter.on_cleanup()

    def publish_transition(
        self, transition: Transition, start: LifecycleState, end: LifecycleState
    ) -> None:
        """Note a transition's result, and publish its two events."""
        self._is_configured = end in (LifecycleState.INACTIVE, LifecycleState.ACTIVE)
        for event in transition_events(transition, start, end):
            self._events.publish(event)

    def _make_adapter(self) -> ControllerAdapter[Any] | None:
        path = self.controller.adapter
        return load_object(path)(self.controller, self, self._loop) if path else None

    def _change_parameters(self, changed: Sequence[Parameter]) -> SetParametersResult:
        """Apply new values, or return why not; on the executor's thread.

        It waits for the loop, usually a fraction of a tick, so that the answer is reliable.
        """
        values = self.values_of(self._specs)
        changes = {item.name: item.value for item in changed if item.name in values}
        reason = self._take({**values, **changes}) if changes else ""
        return SetParametersResult(successful=not reason, reason=reason)

    def _parameters_stored(self, _changed: Sequence[Parameter]) -> None:
        """Apply a change that was checked before the controller was configured."""
        reason = self.take_late_changes() if self._is_configured else ""
        if reason:
            logging.getLogger(self.get_name()).error("a parameter change has no effect: %s", reason)

    def _take(self, values: Mapping[str, Any]) -> str:
        """Pass values to the controller if it is configured; return why it refuses them."""
        reason = self._fault_of(values)
        if not self._is_configured:
            # A client may set several values one by one that only fit together at the end.
            return "" if self._fault_of(self.values_of(self._specs)) else reason
        if reason:
            return reason
        in_force = self._in_force(values)
        reason = self._fault_of(in_force) or self._update_parameters(in_force)
        if not reason:
            self._values_taken = in_force
        return reason

    def _in_force(self, values: Mapping[str, Any]) -> Mapping[str, Any]:
        """Return the values that a configured controller uses.

        Values that it reads only at its configuration keep their values from then.
        """
        taken = self._values_taken
        kept = {spec.name: taken[spec.name] for spec in self._specs if spec.at_configuration}
        return {**values, **kept}

    def _fault_of(self, values: Mapping[str, Any]) -> str:
        """Return why the controller cannot use these values, or an empty string."""
        try:
            self.controller.build_parameters(values)
        except ParameterError as error:
            return str(error)
        return ""

    def _update_parameters(self, values: Mapping[str, Any]) -> str:
        # On the loop thread, which also changes the controller's state.
        controller = self.controller
        parameters = controller.build_parameters(values)

        def update() -> str:
            if not self._is_configured:
                return ""  # It was cleaned up meanwhile; the next configuration reads the values.
            return failure_of(
                lambda: controller.change_parameters(parameters),
                f"update_parameters of controller '{controller.name}'",
            )

        future = self._loop.call(update)
        try:
            return future.result(LOOP_TIMEOUT_S)
        except FutureTimeoutError:
            future.cancel()
            return f"the control loop did not apply the change within {LOOP_TIMEOUT_S:g} s"
        except LoopStoppedError as error:
            return str(error)
