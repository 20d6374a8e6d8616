"""The action by which a gripper controller takes positions."""

import uuid
from typing import Any

from control_msgs.action import GripperCommand, ParallelGripperCommand
from rclpy.node import Node
from sensor_msgs.msg import JointState
from unique_identifier_msgs.msg import UUID

from arm_viewer.joint_drive import DriveKind, JointDrive
from arm_viewer.joint_move import JointMove
from arm_viewer.ros.inquiry import Inquiry

ACTIONS = {
    DriveKind.GRIPPER: GripperCommand,
    DriveKind.PARALLEL_GRIPPER: ParallelGripperCommand,
}


class GripperGoals:
    """Sends moves as goals; used by the executor's thread alone.

    A slider says more than the action can take: while a goal is not answered only the newest move
    is kept. A goal is a request to one of the action's services; how it ends /joint_states shows.
    """

    def __init__(self, node: Node, drive: JointDrive) -> None:
        """Make the client."""
        self._service_class: Any = ACTIONS[drive.kind].Impl.SendGoalService
        self._service = Inquiry(node, self._service_class, f"{drive.name}/_action/send_goal")
        self._waiting: JointMove | None = None

    def send(self, move: JointMove) -> None:
        """Send a move, as soon as the one before is answered."""
        self._waiting = move
        self._ask()

    def close(self) -> None:
        """End the client."""
        self._service.close()

    def _ask(self) -> None:
        if self._waiting is None:
            return
        request = self._service_class.Request(
            goal_id=UUID(uuid=list(uuid.uuid4().bytes)), goal=_goal(self._waiting)
        )
        if self._service.ask(request, lambda _: self._ask()):
            self._waiting = None


def _goal(move: JointMove) -> Any:
    (joint,), (position,) = move.drive.joints, move.positions
    if move.drive.kind is DriveKind.PARALLEL_GRIPPER:
        command = JointState(name=[joint], position=[position])
        return ParallelGripperCommand.Goal(command=command)
    goal = GripperCommand.Goal()
    goal.command.position = position
    return goal
