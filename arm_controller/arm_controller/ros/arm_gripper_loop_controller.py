"""The node arm_gripper_loop_controller: moves an arm and its gripper by their actions."""

import threading
from typing import Any

from control_msgs.action import FollowJointTrajectory, GripperCommand
from rclpy.action.client import ActionClient, ClientGoalHandle
from rclpy.clock import Clock
from rclpy.node import Node
from rclpy.task import Future
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from arm_controller.parameter_values import read_joint_names, read_number
from arm_controller.ros.clock_time import steady_clock
from arm_controller.ros.parameters import declare

JOINTS = [
    "link1_to_link2",
    "link2_to_link3",
    "link3_to_link4",
    "link4_to_link5",
    "link5_to_link6",
    "link6_to_link6_flange",
]
ARM_ACTION = "arm_controller/follow_joint_trajectory"
GRIPPER_ACTION = "gripper_action_controller/gripper_cmd"
POLL_S = 0.1
REMINDER_S = 10.0
CANCEL_TIMEOUT_S = 2.0
GONE = "its action server is gone"


class ArmGripperLoopController(Node):
    """An `ArmWithGripper` by actions: every movement is awaited to its real result.

    The coroutines run in the executor's thread, `stop` in any other.

    Raises:
        ParameterValueError: a parameter that was given makes no sense.
    """

    def __init__(self) -> None:
        super().__init__("arm_gripper_loop_controller")
        self._joints = declare(
            self, "joints", JOINTS, read_joint_names, "Joints of the arm, in the poses' order"
        )
        self._move_s = declare(
            self, "trajectory_time", 2.0, read_number, "How long the arm takes for a way (s)"
        )
        self._max_effort = declare(
            self, "max_effort", 5.0, read_number, "What the gripper's goals ask for"
        )
        self._arm = ActionClient(self, FollowJointTrajectory, ARM_ACTION)
        self._gripper = ActionClient(self, GripperCommand, GRIPPER_ACTION)
        self._under_way: ClientGoalHandle | None = None

    async def connect(self) -> None:
        """Return once both action servers are there; say so, and what is missing."""
        if not self._missing():
            return
        self.get_logger().info("Waiting for action servers...")
        polls = 0
        while missing := self._missing():
            await self._wait(POLL_S, steady_clock())
            polls += 1
            if polls % round(REMINDER_S / POLL_S) == 0:
                names = " and ".join(missing)
                self.get_logger().warning(f"no action server for {names}: does the robot run?")
        self.get_logger().info("Action servers connected!")

    async def move_arm(self, positions: tuple[float, ...]) -> str | None:
        """Follow a trajectory of one point; return why it did not get there."""
        point = JointTrajectoryPoint(positions=positions)
        point.time_from_start.sec = int(self._move_s)
        point.time_from_start.nanosec = int(self._move_s % 1 * 1e9)
        trajectory = JointTrajectory(joint_names=self._joints, points=[point])
        result = await self._carry_out(self._arm, FollowJointTrajectory.Goal(trajectory=trajectory))
        if isinstance(result, str):
            return result
        if result.error_code == FollowJointTrajectory.Result.SUCCESSFUL:
            return None
        return result.error_string or f"error {result.error_code}"

    async def move_gripper(self, position: float) -> str | None:
        """Command the gripper; return why it did not get there."""
        goal = GripperCommand.Goal()
        goal.command.position, goal.command.max_effort = position, self._max_effort
        result = await self._carry_out(self._gripper, goal)
        if isinstance(result, str):
            return result
        if result.reached_goal:
            return None
        why = "something is in the way" if result.stalled else "the goal was ended"
        return f"stopped at {result.position:.3f} rad, {why}"

    async def pause(self, seconds: float) -> None:
        """Return after some time of the node's clock."""
        await self._wait(seconds, self.get_clock())

    def stop(self) -> None:
        """Stop what is under way; blocks until that is confirmed, for two seconds at most."""
        self.get_logger().info("Shutting down arm gripper controller...")
        goal = self._under_way
        if goal is not None:
            confirmed = threading.Event()
            goal.cancel_goal_async().add_done_callback(lambda _: confirmed.set())
            confirmed.wait(CANCEL_TIMEOUT_S)

    def _missing(self) -> list[str]:
        clients = {ARM_ACTION: self._arm, GRIPPER_ACTION: self._gripper}
        return [
            self.resolve_topic_name(name)
            for name, client in clients.items()
            if not client.server_is_ready()
        ]

    async def _carry_out(self, client: ActionClient, goal: Any) -> Any:
        """Return the result of a goal, or a phrase that says why there is none."""
        handle = await self._answer(client, client.send_goal_async(goal))
        if handle is None:
            return GONE
        if not handle.accepted:
            return "the goal was rejected"
        self._under_way = handle
        ended = await self._answer(client, handle.get_result_async())
        self._under_way = None
        return GONE if ended is None else ended.result

    async def _answer(self, client: ActionClient, future: Future) -> Any:
        """Return what a future brings, None where the server goes away first."""
        while not future.done():
            if not client.server_is_ready():
                return None
            await self._wait(POLL_S, steady_clock())
        return future.result()

    async def _wait(self, seconds: float, clock: Clock) -> None:
        over = Future(executor=self.executor)
        timer = self.create_timer(seconds, lambda: over.set_result(None), clock=clock)
        await over
        self.destroy_timer(timer)
