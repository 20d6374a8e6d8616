"""Moves an arm and its gripper through actions, and waits for the result of each movement."""

import math
import time
from collections.abc import Sequence
from typing import Any

import rclpy
from control_msgs.action import FollowJointTrajectory, GripperCommand
from rclpy.action.client import ActionClient, ClientGoalHandle
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.task import Future
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from arm_controller.pick_plan import PathPoint
from arm_controller.ros_node import spin_for

ARM_ACTION = "arm_controller/follow_joint_trajectory"
GRIPPER_ACTION = "gripper_action_controller/gripper_cmd"
POLL_S = 0.1
REMINDER_S = 10.0
ANSWER_TIMEOUT_S = 3.0
CANCEL_TIMEOUT_S = 2.0
GONE = "its action server is gone"


class ArmActions:
    """The action clients of an arm and its gripper. Each method blocks, and serves the node.

    Ctrl-C during a movement cancels its goal: the robot stops where it is.

    Args:
        node: node of the clients; nothing else may spin it.
        joints: joints of the arm, in the order of all positions.
    """

    def __init__(self, node: Node, joints: Sequence[str]) -> None:
        self._node = node
        self._joints = list(joints)
        self._arm = ActionClient(node, FollowJointTrajectory, ARM_ACTION)
        self._gripper = ActionClient(node, GripperCommand, GRIPPER_ACTION)
        self._connected = False

    def connect(self) -> None:
        """Wait for both action servers, and log which are missing.

        The first time says that they are there, even if they are found at once.
        """
        if self._connected and not self._missing():
            return
        logger = self._node.get_logger()
        logger.info("Waiting for action servers...")
        reminded_s = time.monotonic()
        while missing := self._missing():
            spin_for(self._node, POLL_S)
            if time.monotonic() - reminded_s >= REMINDER_S:
                reminded_s = time.monotonic()
                names = " and ".join(missing)
                logger.warning(f"no action server for {names}: does the robot run?")
        self._connected = True
        logger.info("Action servers connected!")

    def follow(self, path: Sequence[PathPoint]) -> str | None:
        """Move the arm; return why it did not reach its goal, or None."""
        trajectory = JointTrajectory(joint_names=self._joints, points=list(map(_message, path)))
        result = self._carry_out(self._arm, FollowJointTrajectory.Goal(trajectory=trajectory))
        if isinstance(result, str):
            return result
        if result.error_code == FollowJointTrajectory.Result.SUCCESSFUL:
            return None
        return result.error_string or f"error {result.error_code}"

    def grip(self, position: float, max_effort: float) -> "GripperCommand.Result | str":
        """Move the gripper to a position in rad; return a phrase if there is no result."""
        goal = GripperCommand.Goal()
        goal.command.position, goal.command.max_effort = position, max_effort
        return self._carry_out(self._gripper, goal)

    def pause(self, duration_s: float) -> None:
        """Return after a time on the node's clock."""
        end = self._node.get_clock().now() + Duration(nanoseconds=round(duration_s * 1e9))
        while self._node.get_clock().now() < end:
            rclpy.spin_once(self._node, timeout_sec=POLL_S)

    def _missing(self) -> list[str]:
        clients = {ARM_ACTION: self._arm, GRIPPER_ACTION: self._gripper}
        return [
            self._node.resolve_topic_name(name)
            for name, client in clients.items()
            if not client.server_is_ready()
        ]

    def _carry_out(self, client: ActionClient, goal: Any) -> Any:
        """Return the result of a goal, or a phrase with the reason why there is none."""
        handle = self._sent(client, goal)
        if handle is None:
            return GONE
        if not handle.accepted:
            return "the goal was rejected"
        try:
            ended = self._answer(client, handle.get_result_async())
        except KeyboardInterrupt:
            cancelled = handle.cancel_goal_async()
            rclpy.spin_until_future_complete(self._node, cancelled, timeout_sec=CANCEL_TIMEOUT_S)
            raise
        return GONE if ended is None else ended.result

    def _sent(self, client: ActionClient, goal: Any) -> ClientGoalHandle | None:
        """Send a goal until it is answered; None if the server disappears first.

        A server that has not discovered this client yet takes the goal, but its answer is lost. The
        same goal once more does no harm: it takes the place of the first.
        """
        while client.server_is_ready():
            handle = self._answer(client, client.send_goal_async(goal), ANSWER_TIMEOUT_S)
            if handle is not None:
                return handle
        return None

    def _answer(self, client: ActionClient, future: Future, timeout_s: float = math.inf) -> Any:
        """Return the result of a future, None if the server disappears or the time ends first."""
        end_s = time.monotonic() + timeout_s
        while not future.done():
            if not client.server_is_ready() or time.monotonic() > end_s:
                return None
            rclpy.spin_until_future_complete(self._node, future, timeout_sec=POLL_S)
        return future.result()


def _message(point: PathPoint) -> JointTrajectoryPoint:
    message = JointTrajectoryPoint(positions=point.positions, velocities=point.velocities)
    message.time_from_start.sec = int(point.time_s)
    message.time_from_start.nanosec = int(point.time_s % 1 * 1e9)
    return message
