"""The trained policy drives a running arm over ROS to random points, each from its initial pose.

    arm launch                      # in another terminal
    python drive_node.py --goals 100

It reads /joint_states, knows the gripper's position from the description, and commands
/position_controller/commands every 0.04 s of simulation time, as in the environment.
"""

import argparse
import sys
from pathlib import Path

import numpy as np
import rclpy
from policy import Array, act, load
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.utilities import try_shutdown
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray

from arm_description.kinematics.forward import forward_kinematics
from arm_description.resources import ResourceFinder
from arm_description.urdf.parser import parse_urdf
from arm_description.urdf.robot import Robot
from arm_description.xacro.expansion import expand_xacro_file

ARM = "package://arm_description/urdf/arm.urdf.xacro"
TIP = "crawer_base"
DECISION_S, EPISODE_S, HELD_S = 0.04, 4.0, 0.2
TOLERANCE_M, HOME_WITHIN_RAD = 0.02, 0.02
RANGE_SHARE, LOWEST_M, NEAREST_M = 0.5, 0.1, 0.08
"""As in arm_sim.gym.reach. This node works without Gymnasium, which that module needs."""
NEEDED_SHARE = 0.95


class Arm:
    """The arm's kinematics and limits, from its description."""

    def __init__(self) -> None:
        file = ResourceFinder(None, ()).find(ARM)
        self._robot: Robot = parse_urdf(expand_xacro_file(file, {}, ()).text)
        moving = [joint for joint in self._robot.joints if joint.limit is not None]
        self.joints = [joint.name for joint in moving]
        limits = [joint.limit for joint in moving if joint.limit is not None]
        self.lower = np.array([limit.lower for limit in limits])
        self.upper = np.array([limit.upper for limit in limits])
        self.step = np.array([limit.velocity for limit in limits]) * DECISION_S

    def tip(self, position: Array) -> Array:
        """Return the gripper's position in the world."""
        positions = dict(zip(self.joints, position.tolist(), strict=True))
        return forward_kinematics(self._robot, positions)[TIP][:3, 3]

    def random_goal(self, random: np.random.Generator) -> Array:
        """Return a random point, drawn like those of the environment."""
        while True:
            point = self.tip(random.uniform(RANGE_SHARE * self.lower, RANGE_SHARE * self.upper))
            if point[2] >= LOWEST_M and np.hypot(point[0], point[1]) >= NEAREST_M:
                return point


class Driver(Node):
    """Drives from goal to goal.

    Attributes:
        reached: whether each goal was reached, in order.
    """

    def __init__(self, weights: Array, goals: int, seed: int) -> None:
        super().__init__("reach_policy")
        self._weights, self._count = weights, goals
        self._arm = Arm()
        self._random = np.random.default_rng(seed)
        self.reached: list[bool] = []
        self._goal = self._arm.random_goal(self._random)
        self._command = self._home = np.zeros(len(self._arm.joints))
        self._is_at_home = False
        self._began_s = self._next_s = self._there_s = 0.0
        self._commands = self.create_publisher(
            Float64MultiArray, "/position_controller/commands", 10
        )
        self.create_subscription(JointState, "/joint_states", self._decide, 10)

    @property
    def is_done(self) -> bool:
        """Whether there are no more goals."""
        return len(self.reached) >= self._count

    def _decide(self, message: JointState) -> None:
        now_s = message.header.stamp.sec + message.header.stamp.nanosec * 1e-9
        if self.is_done or now_s < self._next_s - 1e-6:
            return
        by_name = dict(zip(message.name, message.position, strict=True))
        missing = [name for name in self._arm.joints if name not in by_name]
        if missing:
            self.get_logger().warning(
                f"/joint_states has no position of {', '.join(missing)}: is it another robot's?",
                throttle_duration_sec=5.0,
            )
            return
        position = np.array([by_name[name] for name in self._arm.joints])
        self._next_s = now_s + DECISION_S
        if not self._is_at_home:
            self._go_home(now_s, position)
            return
        error = self._goal - self._arm.tip(position)
        if np.linalg.norm(error) > TOLERANCE_M:
            self._there_s = now_s
        if now_s - self._there_s >= HELD_S or now_s - self._began_s >= EPISODE_S:
            self._finish(now_s, float(np.linalg.norm(error)))
            return
        step = act(self._weights, position, error) * self._arm.step
        self._send(np.clip(self._command + step, self._arm.lower, self._arm.upper))

    def _go_home(self, now_s: float, position: Array) -> None:
        """Return to the pose in which the environment starts; there the next goal begins."""
        self._send(self._home)
        if np.abs(position - self._home).max() <= HOME_WITHIN_RAD:
            self._is_at_home = True
            self._began_s = self._there_s = now_s

    def _send(self, command: Array) -> None:
        self._command = command
        self._commands.publish(Float64MultiArray(data=command.tolist()))

    def _finish(self, now_s: float, distance_m: float) -> None:
        self.reached.append(now_s - self._there_s >= HELD_S)
        took_s = now_s - self._began_s
        what = "reached" if self.reached[-1] else "missed"
        self.get_logger().info(
            f"goal {len(self.reached)} {what} in {took_s:.2f} s, {distance_m * 1e3:.0f} mm away"
        )
        self._goal, self._is_at_home = self._arm.random_goal(self._random), False


def main() -> int:
    """Drive to all goals; return 1 if too few were reached."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--goals", type=int, default=100, help="number of goals (100)")
    parser.add_argument("--seed", type=int, default=1, help="seed of the goals (1)")
    parser.add_argument(
        "--policy", type=Path, default=Path(__file__).with_name("policy.json"), help="the weights"
    )
    options = parser.parse_args()
    rclpy.init()
    driver = Driver(load(options.policy), options.goals, options.seed)
    executor = SingleThreadedExecutor()
    executor.add_node(driver)
    try:
        while not driver.is_done:
            executor.spin_once(timeout_sec=1.0)
    except (KeyboardInterrupt, ExternalShutdownException):
        return 130
    finally:
        driver.destroy_node()
        try_shutdown()
    print(f"{sum(driver.reached)} of {len(driver.reached)} goals reached")
    return 0 if sum(driver.reached) >= NEEDED_SHARE * options.goals else 1


if __name__ == "__main__":
    sys.exit(main())
