"""The controllers that can run trajectories now: configured ones, or those of the manager."""

import threading
from collections.abc import Sequence
from typing import Any

from controller_manager_msgs.srv import ListControllers
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.node import Node

from arm_planning.errors import ControlError, PlanningError
from arm_planning.execution import ControllerKind, TrajectoryController

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


class ControllerList:
    """Finds the controllers; without a configuration it asks the controller manager each time."""

    def __init__(self, node: Node, configured: Sequence[TrajectoryController]) -> None:
        """Prepare with those of moveit_controllers.yaml; without any, the manager is asked.

        Other threads must spin the node.
        """
        self._configured = configured
        self._client = node.create_client(
            ListControllers,
            "controller_manager/list_controllers",
            callback_group=ReentrantCallbackGroup(),
        )

    def available(self) -> Sequence[TrajectoryController]:
        """Return the controllers.

        Raises:
            PlanningError: CONTROL_FAILED: the manager does not answer.
        """
        if self._configured:
            return self._configured
        name = self._client.service_name
        if not self._client.wait_for_service(TIMEOUT_S):
            raise _silence(f"{name} has no server: does the robot, or its simulation, run?")
        answered = threading.Event()
        future = self._client.call_async(ListControllers.Request())
        future.add_done_callback(lambda _: answered.set())
        if not answered.wait(TIMEOUT_S):
            raise _silence(f"{name} did not answer within {TIMEOUT_S:g} s")
        answer: Any = future.result()
        active = [each for each in answer.controller if each.state == "active"]
        return [found for each in active if (found := _controller(each)) is not None]


def _silence(reason: str) -> PlanningError:
    message = f"nobody says which controllers can move the robot: {reason}"
    return ControlError(message)


def _controller(listed: Any) -> TrajectoryController | None:
    if listed.type not in KINDS:
        return None
    kind, action = KINDS[listed.type]
    joints = tuple(dict.fromkeys(name.rpartition("/")[0] for name in listed.claimed_interfaces))
    return TrajectoryController(listed.name, action, kind, joints) if joints else None
