"""The node arm_gripper_loop_controller: move to a target, close, move home, open, for ever."""

from typing import TYPE_CHECKING, Any

from rclpy.node import Node

from arm_controller.pick_plan import CLOSED, HOME, JOINTS, OPEN, PathPoint
from arm_controller.ros_arm_actions import ArmActions
from arm_controller.ros_parameters import declare, read_joint_names, read_positive

if TYPE_CHECKING:
    from arm_node.process import NodeProcess

TARGET = (1.345, -1.23, 0.264, -0.296, 0.389, -1.5)
"""Positions of the arm's joints (rad)."""
PAUSE_S = 1.0


class ArmGripperLoopController(Node):
    """Moves arm and gripper through actions; a position that was not reached is logged.

    Args:
        process: runs the loop in its executor.

    Raises:
        ParameterValueError: a given parameter is invalid.
    """

    def __init__(self, process: "NodeProcess") -> None:
        super().__init__("arm_gripper_loop_controller")
        self._process = process
        joints = declare(
            self, "joints", list(JOINTS), read_joint_names, "Joints of the arm, in the poses' order"
        )
        self._move_s = declare(
            self, "trajectory_time", 2.0, read_positive, "Duration of a movement of the arm (s)"
        )
        self._max_effort = declare(
            self, "max_effort", 5.0, read_positive, "Effort limit of the gripper's goals"
        )
        self._actions = ArmActions(self, joints)

    def start(self) -> None:
        """Begin the loop, in the executor's thread."""
        self._process.executor.create_task(self._run_for_ever)

    def stop(self) -> None:
        """Cancel the running movement; call it in any thread but the executor's."""
        self.get_logger().info("Shutting down arm gripper controller...")
        self._actions.stop()

    async def _run_for_ever(self) -> None:
        while True:
            await run_once(self._actions, self.get_logger(), self._move_s, self._max_effort)


async def run_once(robot: ArmActions, logger: Any, move_s: float, max_effort: float) -> None:
    """Move arm and gripper to the target and back; first wait until they can be moved."""

    async def move_arm(place: str, positions: tuple[float, ...]) -> None:
        logger.info(f"Moving to {place} position")
        # Without velocities the joints move at constant speed, as in the tutorial.
        failure = await robot.follow([PathPoint(move_s, positions, ())])
        if failure is None:
            logger.info(f"Reached {place} position - Pausing")
        else:
            logger.error(f"{place.capitalize()} position not reached: {failure}")
        await robot.pause(PAUSE_S)

    async def move_gripper(doing: str, position: float) -> None:
        logger.info(f"{doing} gripper")
        result = await robot.grip(position, max_effort)
        if isinstance(result, str):
            logger.warning(f"{doing} gripper: {result}")
        elif not result.reached_goal:
            why = "something is in the way" if result.stalled else "the goal ended early"
            logger.warning(f"{doing} gripper: stopped at {result.position:.3f} rad, {why}")

    await robot.connect()
    await move_arm("target", TARGET)
    await move_gripper("Closing", CLOSED)
    await move_arm("home", HOME)
    await move_gripper("Opening", OPEN)
    await robot.pause(PAUSE_S)
