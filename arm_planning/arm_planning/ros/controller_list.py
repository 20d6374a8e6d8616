"""The controllers that can run trajectories now: configured ones, or those of the manager."""

import logging
import threading
from collections.abc import Sequence
from typing import Any

from controller_manager_msgs.srv import ListControllers
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.node import Node

from arm_planning.execution.controllers import ControllerKind, TrajectoryController

TIMEOUT_S = 2.0
KINDS = {
    "joint_trajectory_controller/JointTrajectoryController": (
        ControllerKind.FOLLOW_JOINT_TRAJECTORY,
        "follow_joint_trajectory",
    ),
    "position_controllers/GripperActionController": (
        ControllerKind.GRIPPER_COMMAND,
        "gripper_cmd",
    ),
    "effort_controllers/GripperActionController": (ControllerKind.GRIPPER_COMMAND, "gripper_cmd"),
    "parallel_gripper_action_controller/GripperActionController": (
        ControllerKind.PARALLEL_GRIPPER_COMMAND,
        "gripper_cmd",
    ),
}
LOGGER = logging.getLogger("move_group")


class ControllerList:
    """Finds the controllers; without a configuration it asks the controller manager each time."""

    def __init__(self, node: Node, configured: Sequence[TrajectoryController]) -> None:
        """Prepare; other threads must spin the node.

        Args:
            node: has the client.
            configured: the controllers of moveit_controllers.yaml; empty to ask the manager.
        """
        self._configured = configured
        self._client = node.create_client(
            ListControllers,
            "controller_manager/list_controllers",
            callback_group=ReentrantCallbackGroup(),
        )

    def available(self) -> Sequence[TrajectoryController]:
        """Return the controllers; none if the manager does not answer."""
        if self._configured:
            return self._configured
        if not self._client.wait_for_service(TIMEOUT_S):
            LOGGER.warning("no controller manager answers, so no controllers are known")
            return ()
        answered = threading.Event()
        future = self._client.call_async(ListControllers.Request())
        future.add_done_callback(lambda _: answered.set())
        if not answered.wait(TIMEOUT_S):
            LOGGER.warning("the controller manager did not answer within %g s", TIMEOUT_S)
            return ()
        answer: Any = future.result()
        active = [each for each in answer.controller if each.state == "active"]
        return [found for each in active if (found := _controller(each)) is not None]


def _controller(listed: Any) -> TrajectoryController | None:
    if listed.type not in KINDS:
        return None
    kind, action = KINDS[listed.type]
    joints = tuple(dict.fromkeys(name.rpartition("/")[0] for name in listed.claimed_interfaces))
    return TrajectoryController(listed.name, action, kind, joints) if joints else None
