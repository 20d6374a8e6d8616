"""The node publisher_defined: moves the arm to the poses in a file, one after the other.

poses:
  - [0.5, 0.5, 0.5, 0.5]
  - [0.0, 0.0, 0.0, 0.0]
"""

from collections.abc import Mapping
from dataclasses import dataclass
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING

from ament_index_python.packages import get_package_share_directory
from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.node import Node

from arm_controller.pose import Limits, Pose, PoseError, check_limits, shortest_move, shown
from arm_controller.pose_file import read_pose_file
from arm_controller.ros_joint_states import JointReadings
from arm_controller.ros_parameters import (
    declare,
    declare_course,
    declare_joints,
    declare_match_timeout_s,
    read_positive,
    read_zero_or_more,
)
from arm_controller.ros_position_commands import GRACE_S, POLL_S, PositionCommands
from arm_node.parameter_values import read_path

if TYPE_CHECKING:
    from arm_node.process import NodeProcess


@dataclass(slots=True)
class Approach:
    """The movement to one pose after its publication. Times are from the node's clock (s).

    Attributes:
        pose: the goal of the joints.
        limits: the joints' ranges and speeds.
        start: known positions by joint name at the publication.
        started_s: time of the publication.
        tolerance: how close (rad or m) each joint must come.
        timeout_s: how long it may take.
    """

    pose: Pose
    limits: Limits
    start: Mapping[str, float]
    started_s: float
    tolerance: float
    timeout_s: float

    def elapsed_s(self, now_s: float) -> float:
        """Return the time since the start; setting the clock back restarts it."""
        self.started_s = min(self.started_s, now_s)
        return now_s - self.started_s

    def is_reached(self, positions: Mapping[str, float]) -> bool:
        """Return whether every joint is known to be within the tolerance."""
        return all(
            abs(positions.get(name, float("nan")) - goal) <= self.tolerance
            for name, goal in self._goals.items()
        )

    def forecast(self) -> str | None:
        """Return a sentence if the joints are too slow to reach the pose within the timeout."""
        joint, needed_s = shortest_move(self.pose, self.start, self.limits)
        if needed_s <= self.timeout_s:
            return None
        return (
            f"joint '{joint.name}' needs at least {needed_s:.1f} s at its velocity limit of "
            f"{joint.velocity:g} {joint.unit}/s, and the timeout is {self.timeout_s:g} s "
            "(parameter timeout)"
        )

    def shortfall(self, positions: Mapping[str, float]) -> str:
        """Return a sentence on why the pose was not reached."""
        missing = [name for name in self._goals if name not in positions]
        if missing and not positions:
            return "/joint_states is silent: is the joint_state_broadcaster active?"
        if missing:
            existing = ", ".join(sorted(positions))
            return f"no joint '{missing[0]}' in /joint_states, which has {existing}"
        for name in self._goals:
            if not isfinite(positions[name]):
                return f"the position of joint '{name}' in /joint_states is not a number"
        errors = {name: abs(positions[name] - goal) for name, goal in self._goals.items()}
        name = max(errors, key=lambda name: (errors[name], name))
        unit = next(limit.unit for limit in self.limits if limit.name == name)
        return (
            f"joint '{name}' is at {positions[name]:.4f}, {errors[name]:.4f} {unit} from "
            f"{self._goals[name]:.4f} (tolerance {self.tolerance:g}); "
            f"{self.forecast() or self._suspicion()}"
        )

    def _suspicion(self) -> str:
        joint, needed_s = shortest_move(self.pose, self.start, self.limits)
        cause = "something is in its way or another node commands the arm"
        if needed_s == 0.0:
            return cause
        return f"at its velocity limit joint '{joint.name}' needs only {needed_s:.1f} s, so {cause}"

    @property
    def _goals(self) -> dict[str, float]:
        names = (limit.name for limit in self.limits)
        return dict(zip(names, self.pose, strict=True))


class PublisherDefined(Node):
    """Publishes a pose, waits until the joints reach it, and goes on with the next.

    A pose that is beyond the limits or not reached is counted, and the next one follows.

    Args:
        process: ends after the last pose; with exit code 1 if a pose was not reached.

    Raises:
        ParameterValueError: a given parameter is invalid.
        PoseFileError: the file of poses cannot be used.
    """

    def __init__(self, process: "NodeProcess") -> None:
        super().__init__("publisher_defined")
        self._process = process
        course = declare_course(self)
        joints = declare_joints(self)
        default_file = Path(get_package_share_directory("arm_controller")) / "config/poses.yaml"
        file = declare(self, "poses_file", str(default_file), read_path, "YAML file with the poses")
        self._match_timeout_s = declare_match_timeout_s(self)
        self._poses = read_pose_file(file, joints)
        self._tolerance = declare(
            self, "tolerance", 0.02, read_positive, "How close each joint must come (rad or m)"
        )
        self._timeout_s = declare(
            self,
            "timeout",
            course.get("timeout", 30.0),
            read_positive,
            "How long one pose may take (s)",
        )
        self._pause_s = declare(
            self,
            "pause",
            course.get("pause", 0.0),
            read_zero_or_more,
            "Shortest time from one pose to the next (s); 0 = as soon as it is reached",
        )
        self._index = self._missed = 0
        self._published_s = float("-inf")
        self._approach: Approach | None = None
        self._states = JointReadings(self)
        self._commands = PositionCommands(self, joints)
        # The timer uses the steady clock, so that it also runs while a simulation is paused.
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        self._timer = self.create_timer(POLL_S, self._go_on, clock=steady)

    def _go_on(self) -> None:
        now_s = self.get_clock().now().nanoseconds * 1e-9
        self._commands.observe()
        has_news = self._states.take()
        if self._approach is not None:
            self._follow(self._approach, has_news, now_s)
        self._published_s = min(self._published_s, now_s)  # A simulation's clock may be set back.
        if self._index >= len(self._poses):
            self._end()
        elif self._commands.silence_s >= self._match_timeout_s:
            self._give_up(f"{self._commands.listeners}: is the position_controller active?")
        elif self._approach is None and now_s - self._published_s >= self._pause_s:
            self._publish_if_ready(self._poses[self._index], now_s)

    def _follow(self, approach: Approach, has_news: bool, now_s: float) -> None:
        """Go on to the next pose if this one is reached, or late."""
        positions, elapsed_s = self._states.positions, approach.elapsed_s(now_s)
        if has_news and approach.is_reached(positions):
            self.get_logger().info(f"{self._label} reached after {elapsed_s:.1f} s")
            self._next(missed=False)
        elif elapsed_s >= self._timeout_s:
            self.get_logger().error(
                f"{self._label} not reached within {self._timeout_s:g} s: "
                f"{approach.shortfall(positions)}"
            )
            self._next(missed=True)

    def _publish_if_ready(self, pose: Pose, now_s: float) -> None:
        limits = self._commands.limits
        try:
            check_limits(pose, limits)
        except PoseError as error:
            self.get_logger().error(f"{self._label} {shown(pose)} is skipped: {error}")
            self._next(missed=True)
            return
        if not self._commands.is_ready:
            return
        waited_s = self._commands.unchanged_s
        if now_s == 0.0:
            # With use_sim_time the clock is 0 until /clock arrives, so no timeout would pass.
            if waited_s >= self._match_timeout_s:
                self._give_up("use_sim_time is true and /clock is silent: does a simulation run?")
            return
        if not self._states.positions and waited_s < GRACE_S:
            return
        self.get_logger().info(f"{self._label}: publishing positions: {shown(pose)}")
        start = dict(self._states.positions)
        approach = Approach(pose, limits, start, now_s, self._tolerance, self._timeout_s)
        self._approach, self._published_s = approach, now_s
        self._commands.publish(pose)
        forecast = approach.forecast()
        if forecast is not None:
            self.get_logger().warning(f"{self._label} cannot be reached in time: {forecast}")

    @property
    def _label(self) -> str:
        return f"Pose {self._index + 1} of {len(self._poses)}"

    def _next(self, *, missed: bool) -> None:
        self._missed += missed
        self._index += 1
        self._approach = None

    def _give_up(self, reason: str) -> None:
        self.get_logger().error(reason)
        self._missed += len(self._poses) - self._index
        self._index = len(self._poses)
        self._approach = None

    def _end(self) -> None:
        self._timer.cancel()
        count = len(self._poses)
        if self._missed:
            self.get_logger().error(f"{self._missed} of {count} poses not reached")
        else:
            self.get_logger().info(f"All {count} poses reached")
        self._process.stop(1 if self._missed else 0)
