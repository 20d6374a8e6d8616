"""The node of one controller: its parameters, its adapter, its transition events."""

import logging
from collections.abc import Mapping, Sequence
from concurrent.futures import TimeoutError as FutureTimeoutError
from typing import Any

from lifecycle_msgs.msg import TransitionEvent
from rcl_interfaces.msg import SetParametersResult
from rclpy.parameter import Parameter
from rclpy.qos import QoSProfile

from arm_control.control_loop import ControlLoop
from arm_control.controller import Controller
from arm_control.errors import LoopStoppedError, ParameterError
from arm_control.guarded import failure_of
from arm_control.lifecycle import LifecycleState, Transition
from arm_control.parameters import ParameterSpec, specs_of
from arm_control.registry import load_object
from arm_control.ros.controller_adapter import ControllerAdapter
from arm_control.ros.convert import transition_events
from arm_control.ros.manager_settings import ManagerSettings
from arm_control.ros.parameter_node import ParameterNode

EVENT_DEPTH = 10
LOOP_TIMEOUT_S = 1.0


class ControllerNode(ParameterNode):
    """A plain node named after its controller, in the manager's namespace.

    It has no life-cycle services, as a real controller has none. Made and destroyed on a
    control-plane thread; only `publish_transition` is for the loop thread, and must hear of every
    transition: parameters go to the controller while it is configured.
    """

    def __init__(
        self,
        controller: Controller[Any],
        type_name: str,
        namespace: str,
        arguments: Sequence[str],
        loop: ControlLoop,
    ) -> None:
        """Make the node and declare the parameters.

        Args:
            controller: the core.
            type_name: its type string, for messages.
            namespace: the manager's.
            arguments: ROS arguments for this node alone.
            loop: runs the controller.

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
        self.controller = controller
        self._loop = loop
        self._is_configured = False
        self._values_taken: Mapping[str, Any] = {}
        self._specs = controller.parameter_specs(self.given_parameters())
        general = _general_specs(controller.context.update_rate_hz)
        self.declare_specs((*self._specs, *general))
        self.warn_of_unknown(
            [spec.name for spec in (*self._specs, *general)],
            type_name,
            # What is given without a node's name is given to every node of the process.
            others=[spec.name for spec in specs_of(ManagerSettings)],
        )
        self._adapter = self._make_adapter()
        self._events = self.create_publisher(
            TransitionEvent, "~/transition_event", QoSProfile(depth=EVENT_DEPTH)
        )
        self.add_on_set_parameters_callback(self._change_parameters)
        self.add_post_set_parameters_callback(self._parameters_stored)

    def read_controller_parameters(self) -> tuple[Any, int]:
        """Return the controller's parameters as they are now, and the update rate asked for.

        Raises:
            ParameterError: a value does not fit.
        """
        self._values_taken = self.values_of(self._specs)
        parameters = self.controller.build_parameters(self._values_taken)
        rate_hz = self.get_parameter("update_rate").value
        if not isinstance(rate_hz, int) or rate_hz < 0:
            raise ParameterError(f"parameter 'update_rate' must not be negative, but is {rate_hz}")
        if self.get_parameter("is_async").value:
            logging.getLogger(self.get_name()).warning(
                "parameter 'is_async' has no effect: controllers run in the control loop"
            )
        return parameters, rate_hz

    def on_configure(self, parameters: Any) -> None:
        """Create the controller's end points."""
        if self._adapter is not None:
            self._adapter.on_configure(parameters)

    def take_late_changes(self) -> str:
        """Hand over what clients set since the parameters were read; return why that fails."""
        values = self.values_of(self._specs)
        return self._take(values) if values != self._values_taken else ""

    def on_cleanup(self) -> None:
        """Destroy the controller's end points."""
        if self._adapter is not None:
            self._adapter.on_cleanup()

    def publish_transition(
        self, transition: Transition, start: LifecycleState, end: LifecycleState
    ) -> None:
        """Go by what a transition did, and publish it: on its way, and where it arrived."""
        self._is_configured = end in (LifecycleState.INACTIVE, LifecycleState.ACTIVE)
        for event in transition_events(transition, start, end):
            self._events.publish(event)

    def _make_adapter(self) -> ControllerAdapter[Any] | None:
        path = self.controller.adapter
        return load_object(path)(self.controller, self, self._loop) if path else None

    def _change_parameters(self, changed: Sequence[Parameter]) -> SetParametersResult:
        """Bring new values into force, or say why not; on the executor's thread.

        It waits for the loop, a fraction of a tick as a rule, so that the answer is true.
        """
        values = self.values_of(self._specs)
        changes = {item.name: item.value for item in changed if item.name in values}
        reason = self._take({**values, **changes}) if changes else ""
        return SetParametersResult(successful=not reason, reason=reason)

    def _parameters_stored(self, _changed: Sequence[Parameter]) -> None:
        """Hand over a change that was looked at before the controller was configured."""
        reason = self.take_late_changes() if self._is_configured else ""
        if reason:
            logging.getLogger(self.get_name()).error("what was set is not used: %s", reason)

    def _take(self, values: Mapping[str, Any]) -> str:
        """Hand values to the controller if it is configured; return why it does not take them."""
        try:
            parameters = self.controller.build_parameters(values)
        except ParameterError as error:
            return str(error)
        if not self._is_configured:
            return ""
        reason = self._update_parameters(parameters)
        if not reason:
            self._values_taken = values
        return reason

    def _update_parameters(self, parameters: Any) -> str:
        # On the loop thread, where the controller's state changes, too.
        controller = self.controller

        def update() -> str:
            if not self._is_configured:
                return ""  # any more: the next configuration reads them
            return failure_of(
                lambda: controller.update_parameters(parameters),
                f"update_parameters of controller '{controller.name}'",
            )

        future = self._loop.call(update)
        try:
            return future.result(LOOP_TIMEOUT_S)
        except FutureTimeoutError:
            future.cancel()
            return f"the control loop did not get to the change within {LOOP_TIMEOUT_S:g} s"
        except LoopStoppedError as error:
            return str(error)


def _general_specs(update_rate_hz: int) -> tuple[ParameterSpec, ...]:
    """Return the parameters that every controller has; the manager's rate is the default."""
    return tuple(
        ParameterSpec(name, type(default), False, default, description, read_only=False)
        for name, default, description in (
            ("update_rate", update_rate_hz, "Updates per second"),
            ("is_async", False, "Known from ros2_control; controllers run in the loop"),
            ("thread_priority", -100, "Known from ros2_control; without effect"),
        )
    )
