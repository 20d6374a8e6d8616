"""The node /controller_manager: its parameters, robot_description and /diagnostics."""

import dataclasses
import logging
import sys
import threading
from collections.abc import Callable, Iterable, Iterator, Sequence
from difflib import get_close_matches

from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from rcl_interfaces.msg import ParameterDescriptor, SetParametersResult
from rclpy.node import Node
from rclpy.parameter import Parameter
from std_msgs.msg import String

from arm_control.loop.priority import LoopPriority
from arm_control.manager.diagnostics import HealthReport, ManagerDiagnostics, waiting_reports
from arm_control.manager.node_arguments import manager_arguments
from arm_control.manager.ros.parameter_node import TYPE_OF_CONTROLLER, ParameterNode
from arm_control.manager.settings import ManagerSettings
from arm_control.manager.switch_planner import Strictness
from arm_control.parameters import ParameterSpec, build_parameters, specs_of
from arm_node.qos import LATCHED
from arm_node.ros_logging import LoggerLevelServices
from arm_node.workarounds.clocks import ProcessClock

logger = logging.getLogger("controller_manager")


class DescriptionTopic:
    """Keeps the latest description until one is in use; then it ignores others with a warning.

    Until `use` is called, it belongs to the thread that spins the node.
    """

    def __init__(self, node: Node, in_use: str = "") -> None:
        """Subscribe; `in_use` is the description already in use, empty if there is none."""
        self._in_use = in_use
        self._latest: str | None = None
        self._subscription = node.create_subscription(
            String, "robot_description", self._take, LATCHED
        )

    @property
    def name(self) -> str:
        """Full name of the topic."""
        return self._subscription.topic_name

    def take(self) -> str | None:
        """Return the latest description once; None if there is no new one."""
        latest, self._latest = self._latest, None
        return latest

    def use(self, description: str) -> None:
        """Ignore every other description from now on."""
        self._in_use = description

    def _take(self, message: String) -> None:
        if not self._in_use:
            self._latest = message.data
        elif message.data != self._in_use:
            logger.warning(
                "a robot description other than the one in use was published on %s. "
                "Ignoring attempt to reload a robot description.",
                self.name,
            )


TOPIC = "/diagnostics"
HARDWARE_ID = "ros2_control"

SLICE_S = 1.0
"""A shorter period takes effect after at most this long."""


class HealthPublisher:
    """Publishes one DiagnosticArray per `diagnostic_updater.period` of wall time.

    It has its own thread, because diagnostics matter most when the control loop is stuck and the
    services wait for it. Until `watch` it reports that the manager waits for its description.
    """

    def __init__(
        self, node: Node, settings: Callable[[], ManagerSettings], stamp: Callable[[], Time]
    ) -> None:
        """Prepare the thread; it calls `settings` and `stamp`."""
        self._node = node
        self._settings = settings
        self._stamp = stamp
        self._diagnostics: ManagerDiagnostics | None = None
        self._stopping = threading.Event()
        self._thread = threading.Thread(target=self._run, name="diagnostics", daemon=True)

    def start(self) -> None:
        """Start publishing; the first message follows after one period, to keep the start quick."""
        self._thread.start()

    def watch(self, diagnostics: ManagerDiagnostics) -> None:
        """Report these diagnostics; any thread."""
        self._diagnostics = diagnostics

    def stop(self) -> None:
        """Stop publishing, and wait until the last message has been sent."""
        self._stopping.set()
        if self._thread.is_alive():
            self._thread.join()

    def _run(self) -> None:
        publisher = None
        while self._wait():
            publisher = publisher or self._node.create_publisher(DiagnosticArray, TOPIC, 1)
            publisher.publish(self._message())

    def _wait(self) -> bool:
        """Wait for one period; return False as soon as publishing must stop.

        It waits in slices, because the period may change meanwhile and may even be infinite.
        """
        waited_s = 0.0
        while (rest_s := self._settings().diagnostic_updater.period - waited_s) > 0.0:
            slice_s = min(rest_s, SLICE_S)
            if self._stopping.wait(slice_s):
                return False
            waited_s += slice_s
        return True

    def _message(self) -> DiagnosticArray:
        node, diagnostics = self._node, self._diagnostics
        settings = self._settings()
        reports = (
            waiting_reports()
            if diagnostics is None
            else diagnostics.reports(settings.diagnostics.threshold)
        )
        name = (
            node.get_fully_qualified_name()
            if settings.diagnostic_updater.use_fqn
            else node.get_name()
        )
        message = DiagnosticArray(status=[_status(name, report) for report in reports])
        message.header.stamp = self._stamp()
        return message


def _status(node_name: str, report: HealthReport) -> DiagnosticStatus:
    return DiagnosticStatus(
        level=bytes([report.level]),
        name=f"{node_name}: {report.task}",
        message=report.message,
        hardware_id=HARDWARE_ID,
        values=[KeyValue(key=key, value=value) for key, value in report.values.items()],
    )


MIN_SIMILARITY = 0.85
"""Similarity from which a parameter name counts as a mistyped one (difflib's ratio)."""

USE_SIM_TIME = ("--param", "use_sim_time:=true")

_STRICTNESS = {"best_effort": Strictness.BEST_EFFORT, "strict": Strictness.STRICT}


class ControllerManagerNode(ParameterNode):
    """The manager's node: its own parameters, and the parameters that describe controllers.

    It is created before the hardware, which needs the update rate; `ControllerManagerServer` then
    adds the services.

    Attributes:
        arguments: ROS arguments of the process.
        settings: the node's current parameters; replaced as a whole, any thread may read them.
        health: publishes /diagnostics as long as the node exists.
    """

    def __init__(
        self,
        arguments: Sequence[str] | None = None,
        *,
        namespace: str = "",
        clock: ProcessClock | None = None,
    ) -> None:
        """Make the node.

        Args:
            arguments: command line of the process; default sys.argv.
            namespace: namespace of the node, its controllers and components.
            clock: the clock of a process that makes simulation time, for this node and those of
                controllers and components, which then use simulation time; None for ROS's.

        Raises:
            ParameterError: a parameter has the wrong type or value.
        """
        self.arguments = tuple(sys.argv if arguments is None else arguments)
        self._process_clock = clock
        super().__init__(
            "controller_manager",
            namespace=namespace,
            cli_args=[*manager_arguments(self.arguments), *(USE_SIM_TIME if clock else ())],
            use_global_arguments=False,
            allow_undeclared_parameters=True,
        )
        self.give_clock(self)
        LoggerLevelServices(self)
        self._specs = tuple(self._adapted(specs_of(ManagerSettings)))
        self.declare_specs(self._specs)
        self._warn_of_mistyped()
        self.declare_rest()
        self.settings = self._read_settings()
        self.add_post_set_parameters_callback(self._take)
        self.health = HealthPublisher(self, lambda: self.settings, self.stamp)
        self.health.start()

    def set_parameters_atomically(self, parameter_list: list[Parameter]) -> SetParametersResult:
        """Set parameters, also those that describe controllers that are not loaded yet."""
        types = [item for item in parameter_list if item.name.endswith(".type")]
        for item in types:
            if item.type_ not in (Parameter.Type.STRING, Parameter.Type.NOT_SET):
                reason = f"parameter '{item.name}' must be a text, not {item.value!r}"
                return SetParametersResult(successful=False, reason=reason)
        result = super().set_parameters_atomically(parameter_list)
        for item in types if result.successful else ():
            if self.has_parameter(item.name):
                # What rclpy declares by itself could be set to a value of any type.
                about = ParameterDescriptor(type=Parameter.Type.STRING.value)
                about.description = TYPE_OF_CONTROLLER
                self.set_descriptor(item.name, about)
        return result

    def destroy_node(self) -> None:
        """End the publishing, then the node."""
        self.health.stop()
        super().destroy_node()

    def default_strictness(self) -> Strictness:
        """Return the strictness of a switch request that does not set it."""
        return _STRICTNESS[self.settings.defaults.switch_controller.strictness]

    def loop_priority(self) -> LoopPriority:
        """Return the priority of the loop that updates the controllers."""
        warn_if_denied = "thread_priority" in self.given_parameters()
        return LoopPriority(self.settings.thread_priority, warn_if_denied=warn_if_denied)

    def stamp(self) -> Time:
        """Return the time for a message's header; any thread."""
        return self.get_clock().now().to_msg()

    def clock_arguments(self) -> tuple[str, ...]:
        """Return ROS arguments with which nodes of controllers and components use its clock."""
        return USE_SIM_TIME if self.get_parameter("use_sim_time").value else ()

    def give_clock(self, node: Node) -> None:
        """Give a node that was made with `clock_arguments` the clock of this process, if any."""
        if self._process_clock is not None:
            self._process_clock.give(node)

    def _adapted(self, specs: Iterable[ParameterSpec]) -> Iterator[ParameterSpec]:
        """Yield the parameters, with defaults that depend on other parameters."""
        for spec in specs:
            if spec.name == "overruns.print_warnings":
                # If time comes from /clock, another process determines its pace.
                elsewhere = self.get_parameter("use_sim_time").value and not self._process_clock
                yield dataclasses.replace(spec, default=not elsewhere)
            else:
                yield spec

    def _warn_of_mistyped(self) -> None:
        """Warn of given parameters whose names resemble one of the manager's.

        Any other one may belong to a controller or to ros2_control's own manager.
        """
        own = [spec.name for spec in self._specs]
        for name in set(self.given_parameters()).difference(own):
            for near in get_close_matches(name, own, 1, MIN_SIMILARITY):
                logging.getLogger(self.get_name()).warning(
                    "parameter '%s' is not known to %s and has no effect; did you mean '%s'?",
                    name,
                    self.get_name(),
                    near,
                )

    def _read_settings(self) -> ManagerSettings:
        return build_parameters(ManagerSettings, self.values_of(self._specs))

    def _take(self, changed: Sequence[Parameter]) -> None:
        """Apply the new values."""
        self.settings = self._read_settings()
