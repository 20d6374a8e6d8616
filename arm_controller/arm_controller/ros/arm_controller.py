"""The node arm_controller_node: a pose as a parameter, the joints' states as text."""

from rcl_interfaces.msg import SetParametersResult
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.timer import Timer

from arm_controller.errors import ArmControllerError, PoseError
from arm_controller.joint_readings import JointReadings
from arm_controller.parameter_values import read_flag, read_number, read_pose, read_rate
from arm_controller.pose import JointPose
from arm_controller.ros.clock_time import steady_clock
from arm_controller.ros.command_publisher import POLL_S, CommandPublisher
from arm_controller.ros.joint_state_input import JointStateInput
from arm_controller.ros.parameters import declare, declare_joints

WAIT_WARNING_S = 5.0


class ArmController(Node):
    """Publishes its parameter desired_param each time it is set, and prints joint states.

    It publishes a pose once or, with a publish_rate, on and on.

    Raises:
        ParameterValueError: a parameter that was given makes no sense.
    """

    def __init__(self) -> None:
        super().__init__("arm_controller_node")
        self._steady = steady_clock()
        self._joint_names = declare_joints(self)
        self._commands = CommandPublisher(self, self._joint_names)
        self._pending: JointPose | None = None
        self._announced: JointPose | None = None
        self._warned = False
        self._checks_limits = declare(
            self, "check_limits", True, read_flag, "Publish no pose beyond the limits of a joint"
        )
        rate_hz = declare(
            self,
            "publish_rate",
            0.0,
            read_rate,
            "How often a pose is published (Hz); 0 = once",
        )
        self._repeats = rate_hz > 0.0
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
            None,
            self._read_pose,
            "Pose to publish, one number per joint; each setting publishes it once",
            read_only=False,
        )
        period_s = declare(
            self,
            "print_period",
            1.0,
            self._read_not_negative,
            "Time between two prints of the joint states (s); 0 = never",
            read_only=False,
        )
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

    def _read_not_negative(self, value: object) -> float:
        return read_number(value, positive=False)

    def _check_parameters(self, parameters: list[Parameter]) -> SetParametersResult:
        readers = {"desired_param": self._read_pose, "print_period": self._read_not_negative}
        for parameter in parameters:
            try:
                # Others pass here as well: use_sim_time, QoS overrides.
                if parameter.name in readers:
                    readers[parameter.name](parameter.value)
            except ArmControllerError as error:
                return SetParametersResult(
                    successful=False, reason=f"parameter {parameter.name}: {error}"
                )
        return SetParametersResult(successful=True)

    def _apply_parameters(self, parameters: list[Parameter]) -> None:
        for parameter in parameters:
            if parameter.name == "desired_param":
                self._want(self._read_pose(parameter.value))
            elif parameter.name == "print_period":
                self._print_every(self._read_not_negative(parameter.value))

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
            # The description may have come after the parameter.
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
                f"{self._commands.audience}, so {pose} waits: is the position_controller active?"
            )

    def _announce(self, pose: JointPose) -> None:
        """Say what is published, once."""
        if self._announced is pose:
            return
        self._announced = pose
        self.get_logger().info(f"Publishing positions: {pose}")
        if not self._commands.reaches_controller:
            self.get_logger().warning(self._commands.audience)

    def _print_every(self, period_s: float) -> None:
        if self._print_timer is not None:
            self.destroy_timer(self._print_timer)
        if period_s > 0.0 and self._states is None:
            # Who never prints does not subscribe either: a message to nobody costs nothing.
            self._states = JointStateInput(self, self._readings)
        self._print_timer = (
            self.create_timer(period_s, self._print_states, clock=self._steady)
            if period_s > 0.0
            else None
        )

    def _print_states(self) -> None:
        if self._states is None or not self._states.take():
            return
        for name in self._joint_names:
            reading = self._readings.get(name)
            if reading is None:
                existing = ", ".join(self._readings.names) or "no joints"
                self.get_logger().warning(
                    f"Joint State: no joint '{name}' in /joint_states, which has {existing}"
                )
            else:
                self.get_logger().info(f"Joint State: '{name}' {reading}")
