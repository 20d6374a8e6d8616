"""The node arm_gripper_loop_controller: moves an arm and its gripper through actions."""

from rclpy.node import Node

from arm_controller.joint_path import PathPoint
from arm_controller.mycobot import JOINTS
from arm_controller.parameter_values import read_joint_names, read_positive
from arm_controller.ros.arm_actions import ArmActions
from arm_controller.ros.parameters import declare


class ArmGripperLoopController(Node):
    """An `ArmWithGripper` that uses actions.

    The coroutines run in the executor's thread, `stop` in any other.

    Raises:
        ParameterValueError: a given parameter is invalid.
    """

    def __init__(self) -> None:
        super().__init__("arm_gripper_loop_controller")
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

    async def connect(self) -> None:
        """Wait for both action servers, and log which are missing."""
        await self._actions.connect()

    async def move_arm(self, positions: tuple[float, ...]) -> str | None:
        """Execute a trajectory of one point; return why it did not reach its goal, or None."""
        # Without velocities the joints move at constant speed, as in the tutorial.
        return await self._actions.follow([PathPoint(self._move_s, positions, ())])

    async def move_gripper(self, position: float) -> str | None:
        """Move the gripper; return why it did not reach its goal, or None."""
        result = await self._actions.grip(position, self._max_effort)
        if isinstance(result, str):
            return result
        if result.reached_goal:
            return None
        why = "something is in the way" if result.stalled else "the goal ended early"
        return f"stopped at {result.position:.3f} rad, {why}"

    async def pause(self, seconds: float) -> None:
        """Return after a time on the node's clock."""
        await self._actions.wait(seconds, self.get_clock())

    def stop(self) -> None:
        """Cancel the running movement; block until that is confirmed, for at most two seconds."""
        self.get_logger().info("Shutting down arm gripper controller...")
        self._actions.stop()
