"""The node arm_gripper_loop_controller: move to a target, close, move home, open, for ever."""

from typing import Any

from rclpy.node import Node

from arm_controller.pick_plan import CLOSED, HOME, JOINTS, OPEN, PathPoint
from arm_controller.ros_arm_actions import ArmActions
from arm_controller.ros_node import declare, declare_joints, run

TARGET = (1.345, -1.23, 0.264, -0.296, 0.389, -1.5)
"""Positions of the arm's joints (rad)."""
PAUSE_S = 1.0


class ArmGripperLoopController(Node):
    """Moves arm and gripper through actions; a position that was not reached is logged."""

    def __init__(self) -> None:
        super().__init__("arm_gripper_loop_controller")
        joints = declare_joints(self, JOINTS)
        about = "Duration of a movement of the arm (s)"
        self._move_s = declare(self, "trajectory_time", 2.0, about, (0.001, 1e6))
        about = "Effort limit of the gripper's goals"
        self._max_effort = declare(self, "max_effort", 5.0, about, (0.001, 1e6))
        self._actions = ArmActions(self, joints)

    def run_for_ever(self) -> None:
        """Repeat the movement until Ctrl-C, which stops the arm."""
        try:
            while True:
                run_once(self._actions, self.get_logger(), self._move_s, self._max_effort)
        finally:
            self.get_logger().info("Shutting down arm gripper controller...")


def run_once(robot: ArmActions, logger: Any, move_s: float, max_effort: float) -> None:
    """Move arm and gripper to the target and back; first wait until they can be moved."""

    def move_arm(place: str, positions: tuple[float, ...]) -> None:
        logger.info(f"Moving to {place} position")
        # Without velocities the joints move at constant speed, as in the tutorial.
        failure = robot.follow([PathPoint(move_s, positions, ())])
        if failure is None:
            logger.info(f"Reached {place} position - Pausing")
        else:
            logger.error(f"{place.capitalize()} position not reached: {failure}")
        robot.pause(PAUSE_S)

    def move_gripper(doing: str, position: float) -> None:
        logger.info(f"{doing} gripper")
        result = robot.grip(position, max_effort)
        if isinstance(result, str):
            logger.warning(f"{doing} gripper: {result}")
        elif not result.reached_goal:
            why = "something is in the way" if result.stalled else "the goal ended early"
            logger.warning(f"{doing} gripper: stopped at {result.position:.3f} rad, {why}")

    robot.connect()
    move_arm("target", TARGET)
    move_gripper("Closing", CLOSED)
    move_arm("home", HOME)
    move_gripper("Opening", OPEN)
    robot.pause(PAUSE_S)


def main() -> int:
    """Move the myCobot and its gripper back and forth, until Ctrl-C."""
    return run(ArmGripperLoopController, ArmGripperLoopController.run_for_ever)
