"""The node publisher_defined: moves the arm to the poses in a file."""

from pathlib import Path

from ament_index_python.packages import get_package_share_directory
from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.node import Node

from arm_controller.errors import PoseError
from arm_controller.joint_pose import JointPose
from arm_controller.joint_states import JointReadings
from arm_controller.parameter_values import read_positive, read_zero_or_more
from arm_controller.pose_file import read_pose_file
from arm_controller.pose_sequence import PoseSequence
from arm_controller.ros.command_publisher import (
    GRACE_S,
    POLL_S,
    CommandPublisher,
)
from arm_controller.ros.joint_state_input import JointStateInput
from arm_controller.ros.parameters import (
    declare,
    declare_course,
    declare_joints,
    declare_match_timeout_s,
)
from arm_node.parameter_values import read_path
from arm_node.process import EXIT_FAILED, EXIT_OK, NodeProcess


class PublisherDefined(Node):
    """Publishes a pose, waits until the joints reach it, and goes on with the next.

    Args:
        process: ends after the last pose; with exit code 1 if a pose was not reached.

    Raises:
        ParameterValueError: a given parameter is invalid.
        PoseFileError: the file of poses cannot be used.
    """

    def __init__(self, process: NodeProcess) -> None:
        super().__init__("publisher_defined")
        self._process = process
        declare_course(self)
        joint_names = declare_joints(self)
        default_file = Path(get_package_share_directory("arm_controller")) / "config/poses.yaml"
        poses_file = declare(
            self, "poses_file", str(default_file), read_path, "YAML file with the poses"
        )
        self._match_timeout_s = declare_match_timeout_s(self)
        self._sequence = PoseSequence(
            read_pose_file(poses_file, joint_names),
            tolerance=declare(
                self, "tolerance", 0.02, read_positive, "How close each joint must come (rad or m)"
            ),
            timeout_s=declare(
                self, "timeout", 30.0, read_positive, "How long one pose may take (s)"
            ),
            pause_s=declare(
                self,
                "pause",
                0.0,
                read_zero_or_more,
                "Shortest time from one pose to the next (s); 0 = as soon as it is reached",
            ),
        )
        self._readings = JointReadings()
        self._states = JointStateInput(self, self._readings)
        self._commands = CommandPublisher(self, joint_names)
        # The timer uses the steady clock, so that it also runs while a simulation is paused.
        self._timer = self.create_timer(
            POLL_S, self._go_on, clock=Clock(clock_type=ClockType.STEADY_TIME)
        )

    def _go_on(self) -> None:
        self._commands.observe()
        if self._states.take():
            self._say_if_reached()
        said = self._sequence.on_time(self._readings.positions, self._now_s())
        if said is not None:
            self.get_logger().error(said)
        pose = self._sequence.waiting_pose
        if self._sequence.finished:
            self._end()
        elif self._commands.silence_s >= self._match_timeout_s:
            self._give_up(f"{self._commands.listeners}: is the position_controller active?")
        elif pose is not None and not self._sequence.is_pausing(self._now_s()):
            self._publish_if_ready(pose)

    def _say_if_reached(self) -> None:
        said = self._sequence.on_positions(self._readings.positions, self._now_s())
        if said is not None:
            self.get_logger().info(said)

    def _publish_if_ready(self, pose: JointPose) -> None:
        label = self._sequence.label
        try:
            self._commands.limits.check(pose)
        except PoseError as error:
            self.get_logger().error(f"{label} {pose} is skipped: {error}")
            self._sequence.refuse()
            return
        if not self._commands.is_ready:
            return
        waited_s = self._commands.unchanged_s
        if self._now_s() == 0.0:
            # With use_sim_time the clock is 0 until /clock arrives, so no timeout would pass.
            if waited_s >= self._match_timeout_s:
                self._give_up("use_sim_time is true and /clock is silent: does a simulation run?")
            return
        if not self._readings.names and waited_s < GRACE_S:
            return
        self.get_logger().info(f"{label}: publishing positions: {pose}")
        approach = self._sequence.begin(
            self._commands.limits, self._readings.positions, self._now_s()
        )
        self._commands.publish(pose)
        forecast = approach.forecast()
        if forecast is not None:
            self.get_logger().warning(f"{label} cannot be reached in time: {forecast}")

    def _give_up(self, reason: str) -> None:
        self.get_logger().error(reason)
        self._sequence.give_up()

    def _end(self) -> None:
        self._timer.cancel()
        missed, count = self._sequence.missed, self._sequence.count
        if missed:
            self.get_logger().error(f"{missed} of {count} poses not reached")
        else:
            self.get_logger().info(f"All {count} poses reached")
        self._process.stop(EXIT_FAILED if missed else EXIT_OK)

    def _now_s(self) -> float:
        return self.get_clock().now().nanoseconds * 1e-9
