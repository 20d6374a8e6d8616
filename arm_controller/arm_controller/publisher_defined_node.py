"""The node publisher_defined: moves the arm to the poses in a file, one after the other."""

from collections.abc import Mapping, Sequence
from math import isfinite
from pathlib import Path

from ament_index_python.packages import get_package_share_directory
from rclpy.node import Node

from arm_controller.pose import ArmControllerError, Pose, PoseError, read_pose_file, shown
from arm_controller.ros_arm import GRACE_S, POLL_S, JointReadings, PositionCommands
from arm_controller.ros_node import (
    TIMES_S,
    declare,
    declare_joints,
    declare_match_timeout_s,
    run,
    spin_for,
)


class NotListeningError(ArmControllerError):
    """The robot does not listen, or its clock stands still: no pose can be reached any more."""


class PublisherDefined(Node):
    """Publishes a pose, waits until the joints reach it, and goes on with the next.

    A pose that is beyond the limits or not reached is counted, and the next one follows.
    """

    def __init__(self) -> None:
        super().__init__("publisher_defined")
        self._joints = declare_joints(self)
        poses = Path(get_package_share_directory("arm_controller")) / "config/poses.yaml"
        file = declare(self, "poses_file", str(poses), "YAML file with the poses")
        self._poses = read_pose_file(Path(file).expanduser(), self._joints)
        self._match_timeout_s = declare_match_timeout_s(self)
        about = "How close each joint must come (rad or m)"
        self._tolerance = declare(self, "tolerance", 0.02, about, (1e-6, 1000.0))
        about = "How long one pose may take (s)"
        self._timeout_s = declare(self, "timeout", 30.0, about, TIMES_S)
        about = "Shortest time from one pose to the next (s); 0 = as soon as it is reached"
        self._pause_s = declare(self, "pause", 0.0, about, (0.0, 1e9))
        self._readings = JointReadings(self)
        self._commands = PositionCommands(self, self._joints)

    def visit_all(self) -> int:
        """Move to each pose; return 1 if one of them was not reached."""
        reached, count, published_s = 0, len(self._poses), float("-inf")
        try:
            for number, pose in enumerate(self._poses, 1):
                label = f"Pose {number} of {count}"
                while self._now_s() - published_s < self._pause_s:
                    published_s = min(published_s, self._now_s())  # The clock may be set back.
                    self._poll()
                try:
                    self._wait_until_ready(pose)
                except PoseError as error:
                    self.get_logger().error(f"{label} {shown(pose)} is skipped: {error}")
                    continue
                published_s = self._now_s()
                reached += self._move_to(pose, label)
        except NotListeningError as error:
            self.get_logger().error(str(error))
        if reached < count:
            self.get_logger().error(f"{count - reached} of {count} poses not reached")
            return 1
        self.get_logger().info(f"All {count} poses reached")
        return 0

    def _wait_until_ready(self, pose: Pose) -> None:
        """Wait until a pose that is published now will arrive.

        Raises:
            PoseError: the pose is beyond the limits.
            NotListeningError: there is no subscriber, or use_sim_time is true without a clock.
        """
        while True:
            unchanged_s = self._poll()
            self._commands.check(pose)
            if not self._commands.is_ready:
                continue
            if self._now_s() > 0.0 and (self._readings.states or unchanged_s >= GRACE_S):
                return
            # With use_sim_time the clock is 0 until /clock arrives, so no timeout would pass.
            if self._now_s() == 0.0 and unchanged_s >= self._match_timeout_s:
                raise NotListeningError(
                    "use_sim_time is true and /clock is silent: does a simulation run?"
                )

    def _move_to(self, pose: Pose, label: str) -> bool:
        """Publish a pose; return whether the joints reach it in time."""
        logger = self.get_logger()
        logger.info(f"{label}: publishing positions: {shown(pose)}")
        started_s = self._now_s()
        self._readings.has_news()  # From now on.
        self._commands.publish(pose)
        while True:
            self._poll()
            started_s = min(started_s, self._now_s())  # A simulation's clock may be set back.
            elapsed_s = self._now_s() - started_s
            positions = {name: state[0] for name, state in self._readings.states.items()}
            problem = shortfall(pose, self._joints, positions, self._tolerance)
            if self._readings.has_news() and not problem:
                logger.info(f"{label} reached after {elapsed_s:.1f} s")
                return True
            if elapsed_s >= self._timeout_s:
                problem = problem or "/joint_states has been silent since the pose was published"
                logger.error(f"{label} not reached within {self._timeout_s:g} s: {problem}")
                return False

    def _poll(self) -> float:
        """Serve the node for a moment; return how long the subscribers have been the same (s).

        Raises:
            NotListeningError: there has been no subscriber for too long.
        """
        spin_for(self, POLL_S)
        topic = self._commands.observe()
        if topic.silence_s >= self._match_timeout_s:
            listeners = topic.describe_subscribers()
            raise NotListeningError(f"{listeners}: is the position_controller active?")
        return topic.unchanged_s

    def _now_s(self) -> float:
        return self.get_clock().now().nanoseconds * 1e-9


def shortfall(
    pose: Pose, joints: Sequence[str], positions: Mapping[str, float], tolerance: float
) -> str:
    """Return a sentence on why a pose is not reached, "" if it is.

    Args:
        pose: the goal of the joints (rad or m).
        joints: their names.
        positions: known positions by joint name (rad or m).
        tolerance: how close each joint must come (rad or m).
    """
    if not positions:
        return "/joint_states is silent: is the joint_state_broadcaster active?"
    for name in joints:
        if name not in positions:
            return f"no joint '{name}' in /joint_states, which has {', '.join(sorted(positions))}"
        if not isfinite(positions[name]):
            return f"the position of joint '{name}' in /joint_states is not a number"
    goals = dict(zip(joints, pose, strict=True))
    name = max(joints, key=lambda name: abs(positions[name] - goals[name]))
    off = abs(positions[name] - goals[name])
    if off <= tolerance:
        return ""
    return (
        f"joint '{name}' is at {positions[name]:.4f}, {off:.4f} from {goals[name]:.4f} (tolerance "
        f"{tolerance:g}): it is too slow, something is in its way, or another node commands the arm"
    )


def main() -> int:
    """Publish the poses in a file; return 1 if one of them was not reached."""
    return run(PublisherDefined, PublisherDefined.visit_all)
