"""Moves an arm and its gripper through actions, and waits for the result of each movement."""

import threading
from collections.abc import Sequence
from typing import Any

from control_msgs.action import FollowJointTrajectory, GripperCommand
from rclpy.action.client import ActionClient, ClientGoalHandle
from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.node import Node
from rclpy.task import Future
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from arm_controller.pick_plan import PathPoint

ARM_ACTION = "arm_controller/follow_joint_trajectory"
GRIPPER_ACTION = "gripper_action_controller/gripper_cmd"
POLL_S = 0.1
REMINDER_S = 10.0
CANCEL_TIMEOUT_S = 2.0
GONE = "its action server is gone"


class ArmActions:
    """The action clients of an arm and its gripper.

    The coroutines run in the executor's thread, `stop` in any other.

    Args:
        node: node of the clients.
        joints: joints of the arm, in the order of all positions.
    """

    def __init__(self, node: Node, joints: Sequence[str]) -> None:
        self._node = node
        self._joints = list(joints)
        self._steady = Clock(clock_type=ClockType.STEADY_TIME)
        self._arm = ActionClient(node, FollowJointTrajectory, ARM_ACTION)
        self._gripper = ActionClient(node, GripperCommand, GRIPPER_ACTION)
        self._running_goal: ClientGoalHandle | None = None

    async def connect(self) -> None:
        """Wait for both action servers, and log which are missing."""
        if not self._missing():
            return
        logger = self._node.get_logger()
        logger.info("Waiting for action servers...")
        polls = 0
        while missing := self._missing():
            await self.pause(POLL_S, self._steady)
            polls += 1
            if polls % round(REMINDER_S / POLL_S) == 0:
                names = " and ".join(missing)
                logger.warning(f"no action server for {names}: does the robot run?")
        logger.info("Action servers connected!")

    async def follow(self, path: Sequence[PathPoint]) -> str | None:
        """Move the arm; return why it did not reach its goal, or None."""
        trajectory = JointTrajectory(joint_names=self._joints, points=list(map(_message, path)))
        result = await self._carry_out(self._arm, FollowJointTrajectory.Goal(trajectory=trajectory))
        if isinstance(result, str):
            return result
        if result.error_code == FollowJointTrajectory.Result.SUCCESSFUL:
            return None
        return result.error_string or f"error {result.error_code}"

    async def grip(self, position: float, max_effort: float) -> "GripperCommand.Result | str":
        """Move the gripper to a position in rad; return a phrase if there is no result."""
        goal = GripperCommand.Goal()
        goal.command.position, goal.command.max_effort = position, max_effort
        return await self._carry_out(self._gripper, goal)

    async def pause(self, seconds: float, clock: Clock | None = None) -> None:
        """Return after a time on a clock, by default the node's."""
        over = Future(executor=self._node.executor)
        timer = self._node.create_timer(
            seconds, lambda: over.set_result(None), clock=clock or self._node.get_clock()
        )
        await over
        self._node.destroy_timer(timer)

    def stop(self) -> None:
        """Cancel the running movement; block until that is confirmed, for at most two seconds."""
        goal = self._running_goal
        if goal is not None:
            confirmed = threading.Event()
            goal.cancel_goal_async().add_done_callback(lambda _: confirmed.set())
            confirmed.wait(CANCEL_TIMEOUT_S)

    def _missing(self) -> list[str]:
        clients = {ARM_ACTION: self._arm, GRIPPER_ACTION: self._gripper}
        return [
            self._node.resolve_topic_name(name)
            for name, client in clients.items()
            if not client.server_is_ready()
        ]

    async def _carry_out(self, client: ActionClient, goal: Any) -> Any:
        """Return the result of a goal, or a phrase with the reason why there is none."""
        handle = await self._answer(client, client.send_goal_async(goal))
        if handle is None:
            return GONE
        if not handle.accepted:
            return "the goal was rejected"
        self._running_goal = handle
        ended = await self._answer(client, handle.get_result_async())
        self._running_goal = None
        return GONE if ended is None else ended.result

    async def _answer(self, client: ActionClient, future: Future) -> Any:
        """Return the result of a future, None if the server disappears first."""
        while not future.done():
            if not client.server_is_ready():
                return None
            await self.pause(POLL_S, self._steady)
        return future.result()


def _message(point: PathPoint) -> JointTrajectoryPoint:
    message = JointTrajectoryPoint(positions=point.positions, velocities=point.velocities)
    message.time_from_start.sec = int(point.time_s)
    message.time_from_start.nanosec = int(point.time_s % 1 * 1e9)
    return message
