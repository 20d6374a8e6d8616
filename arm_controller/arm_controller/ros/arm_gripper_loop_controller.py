"""The node arm_gripper_loop_controller: moves an arm and its gripper by their actions."""

from rclpy.node import Node

from arm_controller.mycobot import JOINTS
from arm_controller.parameter_values import read_joint_names, read_number
from arm_controller.ros.arm_actions import ArmActions
from arm_controller.ros.parameters import declare
from arm_controller.way import WayPoint


class ArmGripperLoopController(Node):
    """An `ArmWithGripper` by actions.

    The coroutines run in the executor's thread, `stop` in any other.

    Raises:
        ParameterValueError: a parameter that was given makes no sense.
    """

    def __init__(self) -> None:
        super().__init__("arm_gripper_loop_controller")
        joints = declare(
            self, "joints", list(JOINTS), read_joint_names, "Joints of the arm, in the poses' order"
        )
        self._move_s = declare(
            self, "trajectory_time", 2.0, read_number, "How long the arm takes for a way (s)"
        )
        self._max_effort = declare(
            self, "max_effort", 5.0, read_number, "What the gripper's goals ask for"
        )
        self._actions = ArmActions(self, joints)

    async def connect(self) -> None:
        """Return once both action servers are there; say so, and what is missing."""
        await self._actions.connect()

    async def move_arm(self, positions: tuple[float, ...]) -> str | None:
        """Follow a trajectory of one point; return why it did not get there."""
        # Without velocities: the joints go at a constant pace, as in the tutorial.
        return await self._actions.follow([WayPoint(self._move_s, positions, ())])

    async def move_gripper(self, position: float) -> str | None:
        """Command the gripper; return why it did not get there."""
        result = await self._actions.grip(position, self._max_effort)
        if isinstance(result, str):
            return result
        if result.reached_goal:
            return None
        why = "something is in the way" if result.stalled else "the goal was ended"
        return f"stopped at {result.position:.3f} rad, {why}"

    async def pause(self, seconds: float) -> None:
        """Return after some time of the node's clock."""
        await self._actions.wait(seconds, self.get_clock())

    def stop(self) -> None:
        """Stop what is under way; blocks until that is confirmed, for two seconds at most."""
        self.get_logger().info("Shutting down arm gripper controller...")
        self._actions.stop()
