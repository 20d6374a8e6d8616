"""The node /controller_manager and its parameters."""

import dataclasses
import logging
import sys
from collections.abc import Iterable, Iterator, Sequence
from difflib import get_close_matches

from builtin_interfaces.msg import Time
from rcl_interfaces.msg import SetParametersResult
from rclpy.parameter import Parameter

from arm_control.clock import Clock
from arm_control.controller_switch import Strictness
from arm_control.errors import ParameterError
from arm_control.loop_priority import LoopPriority
from arm_control.parameters import ParameterSpec, build_parameters, specs_of
from arm_control.ros.convert import time_message
from arm_control.ros.health_publisher import HealthPublisher
from arm_control.ros.manager_settings import ManagerSettings
from arm_control.ros.node_arguments import manager_arguments
from arm_control.ros.parameter_node import ParameterNode

NEAR = 0.85
"""Share of letters that a mistyped name has in common with the right one."""

_STRICTNESS = {"best_effort": Strictness.BEST_EFFORT, "strict": Strictness.STRICT}


class ControllerManagerNode(ParameterNode):
    """The manager's node: its own parameters, and whatever is said about controllers.

    It can be made before there is any hardware, because the hardware wants to know the update
    rate; `ControllerManagerServer` then gives it its services.

    Attributes:
        arguments: ROS arguments of the process.
        settings: the node's parameters as they are now; replaced as a whole, any thread may read.
        health: publishes /diagnostics from the node's beginning to its end.
    """

    def __init__(
        self,
        arguments: Sequence[str] | None = None,
        *,
        name: str = "controller_manager",
        namespace: str = "",
        clock: Clock | None = None,
    ) -> None:
        """Make the node.

        Args:
            arguments: of the process; default sys.argv.
            name: of the node.
            namespace: of the node, its controllers and components.
            clock: what its stamps go by, for any thread to read; by default the node's own clock,
                which a process that makes simulation time itself need not ask on /clock.

        Raises:
            ParameterError: a parameter has the wrong type or value.
        """
        self.arguments = tuple(sys.argv if arguments is None else arguments)
        self._stamp_clock = clock
        super().__init__(
            name,
            namespace=namespace,
            cli_args=manager_arguments(self.arguments),
            use_global_arguments=False,
            allow_undeclared_parameters=True,
            enable_logger_service=True,
        )
        self._specs = tuple(self._adapted(specs_of(ManagerSettings)))
        self.declare_specs(self._specs)
        self._warn_of_mistyped()
        self.declare_rest()
        self.settings = self._read_settings()
        self.add_on_set_parameters_callback(self._check)
        self.add_post_set_parameters_callback(self._take)
        self.health = HealthPublisher(self)
        self.health.start()

    def destroy_node(self) -> None:
        """End the publishing, then the node."""
        self.health.stop()
        super().destroy_node()

    def default_strictness(self) -> Strictness:
        """Return the strictness of a switch request that names none."""
        return _STRICTNESS[self.settings.defaults.switch_controller.strictness]

    def loop_priority(self) -> LoopPriority:
        """Return what chooses the scheduler of the loop that updates the controllers."""
        insist = "thread_priority" in self.given_parameters()
        return LoopPriority(self.settings.thread_priority, insist=insist)

    def stamp(self) -> Time:
        """Return the time for a message's header; any thread."""
        if self._stamp_clock is None:
            return self.get_clock().now().to_msg()
        return time_message(self._stamp_clock.now_s())

    def _adapted(self, specs: Iterable[ParameterSpec]) -> Iterator[ParameterSpec]:
        """Yield the parameters, with the defaults that follow from another's value."""
        for spec in specs:
            if spec.name == "overruns.print_warnings":
                # The pace of a simulation's clock is not this process's doing.
                yield dataclasses.replace(
                    spec, default=not self.get_parameter("use_sim_time").value
                )
            else:
                yield spec

    def _warn_of_mistyped(self) -> None:
        """Name given parameters that are nearly one of the manager's own.

        Any other may belong to a controller, or be one that ros2_control knows.
        """
        own = [spec.name for spec in self._specs]
        for name in set(self.given_parameters()).difference(own):
            for near in get_close_matches(name, own, 1, NEAR):
                logging.getLogger(self.get_name()).warning(
                    "parameter '%s' is not known to %s and has no effect; is it '%s'?",
                    name,
                    self.get_name(),
                    near,
                )

    def _read_settings(self) -> ManagerSettings:
        return build_parameters(ManagerSettings, self.values_of(self._specs))

    def _check(self, changed: Sequence[Parameter]) -> SetParametersResult:
        """Refuse values that make no sense, with the reason."""
        specs = {spec.name: spec for spec in self._specs}
        try:
            for parameter in changed:
                if parameter.name in specs:
                    specs[parameter.name].convert(parameter.value)
        except ParameterError as error:
            return SetParametersResult(successful=False, reason=str(error))
        return SetParametersResult(successful=True)

    def _take(self, changed: Sequence[Parameter]) -> None:
        """Let the new values count."""
        self.settings = self._read_settings()
