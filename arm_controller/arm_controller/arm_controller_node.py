"""The node arm_controller_node: publishes the pose in a parameter, and prints joint states."""

from array import array
from collections.abc import Mapping
from string import Formatter
from typing import Any

from rcl_interfaces.msg import SetParametersResult
from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.timer import Timer

from arm_controller.pose import Pose, PoseError, check_limits, read_pose, shown
from arm_controller.ros_joint_states import JointReadings
from arm_controller.ros_parameters import (
    MAX_NUMBER,
    declare,
    declare_course,
    declare_joints,
    read_zero_or_more,
)
from arm_controller.ros_position_commands import POLL_S, PositionCommands
from arm_node.parameter_values import (
    ParameterValueError,
    numbers_in,
    read_flag,
    read_text,
    refusal,
)
from arm_node.parameters import take_other_notations
from arm_node.printable import printable

WAIT_WARNING_S = 5.0
LINE = "Joint State: '{name}' Position: {position} Velocity: {velocity} Effort: {effort}"
FIELDS = ("name", "index", "position", "velocity", "effort")
"""What a line printed for a joint may contain in braces."""


class ArmController(Node):
    """Publishes its parameter desired_param each time it is set, and prints joint states.

    It publishes a pose once or, with a publish_rate, repeatedly.

    Raises:
        ParameterValueError: a given parameter is invalid.
    """

    def __init__(self, _process: object = None) -> None:
        super().__init__("arm_controller_node")
        # Timers use the steady clock, so that they also run while a simulation is paused.
        self._steady = Clock(clock_type=ClockType.STEADY_TIME)
        course = declare_course(self)
        self._joints = declare_joints(self)
        self._commands = PositionCommands(self, self._joints)
        self._pending: Pose | None = None
        self._announced = self._warned = False
        self._checks_limits = declare(
            self, "check_limits", True, read_flag, "Refuse poses beyond a joint's limits"
        )
        rate_hz = declare(
            self,
            "publish_rate",
            course.get("publish_rate", 0.0),
            read_rate,
            "Rate at which a pose is published (Hz); 0 = once",
        )
        self._repeats = rate_hz > 0.0
        self._logs_each = declare(
            self,
            "log_each_publication",
            course.get("log_each_publication", False),
            read_flag,
            "Log a pose each time it is published, instead of once",
        )
        self._header = declare(
            self,
            "print_header",
            course.get("print_header", ""),
            read_text,
            "Line printed before the joint states",
        )
        self._line = declare(
            self,
            "print_format",
            course.get("print_format", LINE),
            read_line_format,
            "Line printed for a joint, with {name}, {index}, {position}, {velocity}, {effort}",
        )
        self._delivery = self.create_timer(
            1.0 / rate_hz if self._repeats else POLL_S,
            self._deliver,
            clock=self._steady,
            autostart=False,
        )
        self._states: JointReadings | None = None
        self._print_timer: Timer | None = None
        self._declare_changeable(course)

    def _declare_changeable(self, course: Mapping[str, Any]) -> None:
        pose = declare(
            self,
            "desired_param",
            array("d", course.get("desired_param", [])),
            self._read_pose,
            "Pose to publish: a list of numbers, one per joint; each setting publishes it once",
            read_only=False,
        )
        period_s = declare(
            self,
            "print_period",
            course.get("print_period", 1.0),
            read_zero_or_more,
            "Interval at which the joint states are printed (s); 0 = never",
            read_only=False,
        )
        take_other_notations(self, "desired_param")
        self._want(pose)
        self._print_every(period_s)
        self.add_on_set_parameters_callback(self._check_parameters)
        self.add_post_set_parameters_callback(self._apply_parameters)

    def _read_pose(self, value: object) -> Pose | None:
        """Return a pose within the limits; None for an empty list."""
        values = numbers_in(value)
        # The parameter service delivers an array.
        if not isinstance(values, list | tuple | array):
            raise refusal(f"a list of {len(self._joints)} numbers", value)
        pose = read_pose(values, self._joints) if values else None
        if pose is not None and self._checks_limits:
            check_limits(pose, self._commands.limits)
        return pose

    def _check_parameters(self, parameters: list[Parameter]) -> SetParametersResult:
        readers = {"desired_param": self._read_pose, "print_period": read_zero_or_more}
        for parameter in parameters:
            try:
                # Other parameters come here as well: use_sim_time, QoS overrides.
                if parameter.name in readers:
                    readers[parameter.name](parameter.value)
            except (ParameterValueError, PoseError) as error:
                reason = f"parameter {parameter.name}: {error}"
                return SetParametersResult(successful=False, reason=reason)
        return SetParametersResult(successful=True)

    def _apply_parameters(self, parameters: list[Parameter]) -> None:
        for parameter in parameters:
            if parameter.name == "desired_param":
                self._want(self._read_pose(parameter.value))
            elif parameter.name == "print_period":
                self._print_every(read_zero_or_more(parameter.value))

    def _want(self, pose: Pose | None) -> None:
        self._pending = pose
        self._announced = self._warned = False
        if pose is None:
            self._delivery.cancel()
        else:
            self._delivery.reset()

    def _deliver(self) -> None:
        pose = self._pending
        if pose is None:
            return
        self._commands.observe()
        try:
            # The description may arrive after the parameter.
            if self._checks_limits:
                check_limits(pose, self._commands.limits)
        except PoseError as error:
            self.get_logger().error(f"Not publishing {shown(pose)}: {error}")
            self._want(None)
            return
        if self._commands.is_ready:
            self._announce(pose)
            self._commands.publish(pose)
            if not self._repeats:
                self._want(None)
        elif not self._warned and self._commands.silence_s >= WAIT_WARNING_S:
            self._warned = True
            self.get_logger().warning(
                f"{self._commands.listeners}, so {shown(pose)} waits: "
                "is the position_controller active?"
            )

    def _announce(self, pose: Pose) -> None:
        """Log the pose: once, or each time; a warning comes once."""
        if self._logs_each or not self._announced:
            self.get_logger().info(f"Publishing positions: {shown(pose)}")
        if not self._announced and not self._commands.reaches_controller:
            self.get_logger().warning(self._commands.listeners)
        self._announced = True

    def _print_every(self, period_s: float) -> None:
        if self._print_timer is not None:
            self.destroy_timer(self._print_timer)
            self._print_timer = None
        if period_s > 0.0:
            # A node that never prints does not subscribe, which saves the cost of the messages.
            self._states = self._states or JointReadings(self)
            self._print_timer = self.create_timer(period_s, self._print_states, clock=self._steady)

    def _print_states(self) -> None:
        if self._states is None or not self._states.take():
            return
        if self._header:
            self.get_logger().info(self._header)
        for index, name in enumerate(self._joints):
            if name in self._states.positions:
                figures = self._states.figures(name)
                self.get_logger().info(self._line.format(name=name, index=index, **figures))
            else:
                existing = printable(", ".join(self._states.positions)) or "no joints"
                self.get_logger().warning(
                    f"Joint State: no joint '{name}' in /joint_states, which has {existing}"
                )


def read_rate(value: object) -> float:
    """Return a rate in Hz, 0 for never; a timer can count its period."""
    rate, least = read_zero_or_more(value), 1.0 / MAX_NUMBER
    if 0.0 < rate < least:
        raise refusal(f"0 or at least {least:g}", value)
    return rate


def read_line_format(value: object) -> str:
    """Return a format of a joint's line, whose fields are among `FIELDS`.

    Raises:
        ParameterValueError: the value is not a text, or has other fields.
    """
    text = read_text(value)
    try:
        parts = list(Formatter().parse(text))
    except ValueError as error:
        raise ParameterValueError(f"the format '{text}' is wrong: {error}") from error
    for _, field, spec, conversion in parts:
        if field is not None and (field not in FIELDS or spec or conversion):
            existing = ", ".join(f"{{{name}}}" for name in FIELDS)
            raise ParameterValueError(f"the format '{text}' may contain only {existing}")
    return text
