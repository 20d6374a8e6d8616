"""The node arm_controller_node: publishes the pose in a parameter, and prints joint states."""

from rcl_interfaces.msg import ParameterDescriptor, SetParametersResult
from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.timer import Timer

from arm_controller.pose import Pose, PoseError, read_pose, shown
from arm_controller.ros_arm import CONTROLLER, POLL_S, JointReadings, PositionCommands
from arm_controller.ros_node import (
    NodeSettingError,
    declare,
    declare_joints,
    given,
    numbers_in,
    run,
)

WAIT_WARNING_S = 5.0
LINE = "Joint State: '{name}' Position: {position} Velocity: {velocity} Effort: {effort}"


class ArmController(Node):
    """Publishes its parameter desired_param each time it is set, and prints joint states.

    It publishes a pose once or, with a publish_rate, repeatedly.
    """

    def __init__(self) -> None:
        super().__init__("arm_controller_node")
        # Timers use the steady clock, so that they also run while a simulation is paused.
        self._steady = Clock(clock_type=ClockType.STEADY_TIME)
        self._joints = declare_joints(self)
        self._commands = PositionCommands(self, self._joints)
        self._pending: Pose | None = None
        self._announced = self._warned = False
        self._print_timer: Timer | None = None
        self._states: JointReadings | None = None
        about = "Refuse poses beyond a joint's limits"
        self._checks_limits = declare(self, "check_limits", True, about)
        about = "Rate at which a pose is published (Hz); 0 = once"
        rate_hz = declare(self, "publish_rate", 0.0, about, (0.0, 1000.0))
        self._repeats = rate_hz > 0.0
        about = "Log a pose each time it is published, instead of once"
        self._logs_each = declare(self, "log_each_publication", False, about)
        about = "Line printed before the joint states"
        self._header = declare(self, "print_header", "", about)
        about = "Line printed for a joint, with {name}, {index}, {position}, {velocity}, {effort}"
        self._line = declare(self, "print_format", LINE, about)
        try:
            self._line.format(name="", index=0, position="", velocity="", effort="")
        except (ValueError, LookupError, AttributeError) as error:
            raise NodeSettingError(
                f"parameter print_format: '{self._line}' may contain {{name}}, {{index}}, "
                "{position}, {velocity} and {effort}"
            ) from error
        period_s = 1.0 / max(rate_hz, 1e-6) if self._repeats else POLL_S
        self._delivery = self.create_timer(period_s, self._deliver, clock=self._steady)
        self._delivery.cancel()
        self._declare_pose()
        about = "Interval at which the joint states are printed (s); 0 = never"
        self._print_every(declare(self, "print_period", 1.0, about, (0.0, 1e9), read_only=False))
        self.get_logger().info("Set the parameter desired_param to move the arm")

    def _declare_pose(self) -> None:
        about = "Pose to publish: a list of numbers, one per joint; each setting publishes it once"
        value = given(self, "desired_param", None)
        numbers = numbers_in(value)
        if numbers is None:
            wanted = f"a list of {len(self._joints)} numbers"
            raise NodeSettingError(f"parameter desired_param: must be {wanted}, not {value!r}")
        self.add_pre_set_parameters_callback(lambda changed: [_in_doubles(one) for one in changed])
        self.add_on_set_parameters_callback(self._check_parameters)
        self.add_post_set_parameters_callback(self._apply_parameters)
        # rclpy cannot tell the type of an empty list, so declare the type, and set the value.
        descriptor, kind = ParameterDescriptor(description=about), Parameter.Type.DOUBLE_ARRAY
        self.declare_parameter("desired_param", kind, descriptor, ignore_override=True)
        (result,) = self.set_parameters([Parameter("desired_param", kind, numbers)])
        if not result.successful:
            raise NodeSettingError(result.reason)

    def _check_parameters(self, parameters: list[Parameter]) -> SetParametersResult:
        try:
            for parameter in parameters:
                # rclpy itself has checked the type, and the range of print_period.
                if parameter.name == "desired_param" and parameter.value:
                    pose = read_pose(parameter.value, self._joints)
                    if self._checks_limits:
                        self._commands.check(pose)
        except PoseError as error:
            return SetParametersResult(successful=False, reason=f"parameter desired_param: {error}")
        return SetParametersResult(successful=True)

    def _apply_parameters(self, parameters: list[Parameter]) -> None:
        for parameter in parameters:
            if parameter.name == "desired_param":
                values = parameter.value
                self._want(read_pose(values, self._joints) if values else None)
            elif parameter.name == "print_period":
                self._print_every(parameter.value or 0.0)

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
        topic = self._commands.observe()
        try:
            # The description may arrive after the parameter.
            if self._checks_limits:
                self._commands.check(pose)
        except PoseError as error:
            self.get_logger().error(f"Not publishing {shown(pose)}: {error}")
            self._want(None)
            return
        if self._commands.is_ready:
            if self._logs_each or not self._announced:
                self.get_logger().info(f"Publishing positions: {shown(pose)}")
            if not self._announced and topic.subscribers != CONTROLLER:
                self.get_logger().warning(topic.describe_subscribers())
            self._announced = True
            self._commands.publish(pose)
            if not self._repeats:
                self._want(None)
        elif not self._warned and topic.silence_s >= WAIT_WARNING_S:
            self._warned = True
            self.get_logger().warning(
                f"{topic.describe_subscribers()}, so {shown(pose)} waits: "
                "is the position_controller active?"
            )

    def _print_every(self, period_s: float) -> None:
        if self._print_timer is not None:
            self.destroy_timer(self._print_timer)
            self._print_timer = None
        if period_s > 0.0:
            # A node that never prints does not subscribe, which saves the cost of the messages.
            self._states = self._states or JointReadings(self)
            self._print_timer = self.create_timer(period_s, self._print_states, clock=self._steady)

    def _print_states(self) -> None:
        if self._states is None or not self._states.has_news():
            return
        if self._header:
            self.get_logger().info(self._header)
        states = self._states.states
        for index, name in enumerate(self._joints):
            if name not in states:
                existing = ", ".join(states) or "no joints"
                self.get_logger().warning(
                    f"Joint State: no joint '{name}' in /joint_states, which has {existing}"
                )
                continue
            position, velocity, effort = (f"{figure:.6f}" for figure in states[name])
            self.get_logger().info(
                self._line.format(
                    name=name, index=index, position=position, velocity=velocity, effort=effort
                )
            )


def _in_doubles(parameter: Parameter) -> Parameter:
    """Return a pose in any notation as a list of doubles; any other parameter unchanged."""
    numbers = numbers_in(parameter.value) if parameter.name == "desired_param" else None
    if numbers is None:
        return parameter
    return Parameter(parameter.name, Parameter.Type.DOUBLE_ARRAY, numbers)


def main() -> int:
    """Run the node until Ctrl-C."""
    return run(ArmController)
