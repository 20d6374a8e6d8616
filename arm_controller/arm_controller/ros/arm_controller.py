"""The node arm_controller_node: publishes the pose in a parameter, and prints joint states."""

from array import array

from rcl_interfaces.msg import SetParametersResult
from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.timer import Timer

from arm_controller.errors import PoseError
from arm_controller.joint_pose import JointPose
from arm_controller.joint_states import JointReadings
from arm_controller.parameter_values import (
    read_joint_format,
    read_pose,
    read_rate,
    read_zero_or_more,
)
from arm_controller.ros.command_publisher import POLL_S, CommandPublisher
from arm_controller.ros.joint_state_input import JointStateInput
from arm_controller.ros.parameters import declare, declare_course, declare_joints
from arm_node.parameter_values import ParameterValueError, read_flag, read_text
from arm_node.parameters import take_other_notations
from arm_node.printable import printable

WAIT_WARNING_S = 5.0
JOINT_FORMAT = "Joint State: '{name}' Position: {position} Velocity: {velocity} Effort: {effort}"


class ArmController(Node):
    """Publishes its parameter desired_param each time it is set, and prints joint states.

    It publishes a pose once or, with a publish_rate, repeatedly.

    Raises:
        ParameterValueError: a given parameter is invalid.
    """

    def __init__(self) -> None:
        super().__init__("arm_controller_node")
        self._steady = Clock(clock_type=ClockType.STEADY_TIME)
        declare_course(self)
        self._joint_names = declare_joints(self)
        self._commands = CommandPublisher(self, self._joint_names)
        self._pending: JointPose | None = None
        self._announced: JointPose | None = None
        self._warned = False
        self._checks_limits = declare(
            self, "check_limits", True, read_flag, "Refuse poses beyond a joint's limits"
        )
        rate_hz = declare(
            self,
            "publish_rate",
            0.0,
            read_rate,
            "Rate at which a pose is published (Hz); 0 = once",
        )
        self._repeats = rate_hz > 0.0
        self._logs_each = declare(
            self,
            "log_each_publication",
            False,
            read_flag,
            "Log a pose each time it is published, instead of once",
        )
        self._print_header = declare(
            self, "print_header", "", read_text, "Line printed before the joint states"
        )
        self._print_format = declare(
            self,
            "print_format",
            JOINT_FORMAT,
            read_joint_format,
            "Line printed for a joint, with {name}, {index}, {position}, {velocity}, {effort}",
        )
        self._delivery = self.create_timer(
            1.0 / rate_hz if self._repeats else POLL_S,
            self._deliver,
            clock=self._steady,
            autostart=False,
        )
        self._readings = JointReadings()
        self._states: JointStateInput | None = None
        self._print_timer: Timer | None = None
        self._declare_changeable()

    def _declare_changeable(self) -> None:
        pose = declare(
            self,
            "desired_param",
            array("d"),
            self._read_pose,
            "Pose to publish: a list of numbers, one per joint; each setting publishes it once",
            read_only=False,
        )
        period_s = declare(
            self,
            "print_period",
            1.0,
            read_zero_or_more,
            "Interval at which the joint states are printed (s); 0 = never",
            read_only=False,
        )
        take_other_notations(self, "desired_param")
        self._want(pose)
        self._print_every(period_s)
        self.add_on_set_parameters_callback(self._check_parameters)
        self.add_post_set_parameters_callback(self._apply_parameters)

    def _read_pose(self, value: object) -> JointPose | None:
        pose = read_pose(value, self._joint_names)
        self._check_limits(pose)
        return pose

    def _check_limits(self, pose: JointPose | None) -> None:
        if pose is not None and self._checks_limits:
            self._commands.limits.check(pose)

    def _check_parameters(self, parameters: list[Parameter]) -> SetParametersResult:
        readers = {"desired_param": self._read_pose, "print_period": read_zero_or_more}
        for parameter in parameters:
            try:
                # Other parameters come here as well: use_sim_time, QoS overrides.
                if parameter.name in readers:
                    readers[parameter.name](parameter.value)
            except (ParameterValueError, PoseError) as error:
                return SetParametersResult(
                    successful=False, reason=f"parameter {parameter.name}: {error}"
                )
        return SetParametersResult(successful=True)

    def _apply_parameters(self, parameters: list[Parameter]) -> None:
        for parameter in parameters:
            if parameter.name == "desired_param":
                self._want(self._read_pose(parameter.value))
            elif parameter.name == "print_period":
                self._print_every(read_zero_or_more(parameter.value))

    def _want(self, pose: JointPose | None) -> None:
        self._pending = pose
        self._announced = None
        self._warned = False
        if pose is None:
            self._delivery.cancel()
        else:
            self._delivery.reset()

    def _deliver(self) -> None:
        if self._pending is None:
            return
        pose = self._pending
        self._commands.observe()
        try:
            # The description may arrive after the parameter.
            self._check_limits(pose)
        except PoseError as error:
            self.get_logger().error(f"Not publishing {pose}: {error}")
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
                f"{self._commands.listeners}, so {pose} waits: is the position_controller active?"
            )

    def _announce(self, pose: JointPose) -> None:
        """Log the pose: once, or each time; a warning comes once."""
        is_new = self._announced is not pose
        self._announced = pose
        if is_new or self._logs_each:
            self.get_logger().info(f"Publishing positions: {pose}")
        if is_new and not self._commands.reaches_controller:
            self.get_logger().warning(self._commands.listeners)

    def _print_every(self, period_s: float) -> None:
        if self._print_timer is not None:
            self.destroy_timer(self._print_timer)
        if period_s > 0.0 and self._states is None:
            # A node that never prints does not subscribe, which saves the cost of the messages.
            self._states = JointStateInput(self, self._readings)
        self._print_timer = (
            self.create_timer(period_s, self._print_states, clock=self._steady)
            if period_s > 0.0
            else None
        )

    def _print_states(self) -> None:
        if self._states is None or not self._states.take():
            return
        if self._print_header:
            self.get_logger().info(self._print_header)
        for index, name in enumerate(self._joint_names):
            reading = self._readings.get(name)
            if reading is None:
                existing = printable(", ".join(self._readings.names)) or "no joints"
                self.get_logger().warning(
                    f"Joint State: no joint '{name}' in /joint_states, which has {existing}"
                )
            else:
                line = self._print_format.format(name=name, index=index, **reading.figures())
                self.get_logger().info(line)
