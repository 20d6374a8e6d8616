"""Asks one move_group for joint positions that bring a group's tip to a pose."""

from collections.abc import Callable
from dataclasses import dataclass, replace

from builtin_interfaces.msg import Duration
from moveit_msgs.msg import MoveItErrorCodes
from moveit_msgs.srv import GetPositionIK
from rclpy.node import Node

from arm_node.rigid_transform import RigidTransform
from arm_planning.robot.model import JointPositions
from arm_planning.ros.convert import pose_message
from arm_viewer.ros.goal_checker import state_message
from arm_viewer.ros.service_caller import ServiceCaller

TIMEOUT, AVOIDING_TIMEOUT = Duration(nanosec=50_000_000), Duration(sec=2)
"""How long a pose that cannot be reached may hold up the next one; one that is looked for in any
posture comes alone."""

Take = Callable[["TipPose", JointPositions | None, str], None]
"""Takes what was asked, and the positions, or None and why there are none."""


@dataclass(frozen=True, slots=True)
class TipPose:
    """Where a group's tip is to be, in the frame of a link.

    If it `avoids`, a posture that touches nothing is sought first.
    """

    group: str
    tip: str
    frame: str
    pose: RigidTransform
    avoids: bool = False


class TipSolver:
    """Solves the latest pose, one at a time. Use it in the executor's thread."""

    def __init__(
        self, node: Node, namespace: str, seed: Callable[[str], JointPositions], take: Take
    ) -> None:
        """Create the client; `seed` returns the positions from which a group's are sought."""
        self._service = ServiceCaller(node, GetPositionIK, f"{namespace}/compute_ik")
        self._seed = seed
        self._take = take
        self._waiting: TipPose | None = None
        self._asked: TipPose | None = None

    @property
    def is_busy(self) -> bool:
        """Whether a pose is still sought."""
        return self._waiting is not None or self._asked is not None

    def solve(self, wanted: TipPose) -> None:
        """Solve a pose as soon as the one before is answered; the latest one wins."""
        self._waiting = wanted
        self.ask()

    def ask(self) -> None:
        """Ask if the service is free; call it periodically."""
        if self._asked is not None and self._service.is_overdue():
            asked, self._asked = self._asked, None
            self._service.forget()
            self._take(asked, None, f"{self._service.service} does not answer")
        wanted = self._waiting
        if wanted is None:
            return
        request = GetPositionIK.Request()
        asked = request.ik_request
        asked.group_name, asked.ik_link_name = wanted.group, wanted.tip
        asked.robot_state = state_message(self._seed(wanted.group))
        asked.pose_stamped.header.frame_id = wanted.frame
        asked.pose_stamped.pose = pose_message(wanted.pose)
        asked.timeout = AVOIDING_TIMEOUT if wanted.avoids else TIMEOUT
        # Otherwise, what the goal touches is shown.
        asked.avoid_collisions = wanted.avoids
        if self._service.ask(request, lambda answer: self._answer(wanted, answer)):
            self._waiting, self._asked = None, wanted

    def close(self) -> None:
        """Destroy the client."""
        self._service.close()

    def _answer(self, asked: TipPose, answer: GetPositionIK.Response) -> None:
        self._asked = None
        if asked.avoids and answer.error_code.val != MoveItErrorCodes.SUCCESS:
            self._waiting = self._waiting or replace(asked, avoids=False)
            self.ask()
            return
        if answer.error_code.val == MoveItErrorCodes.SUCCESS:
            state = answer.solution.joint_state
            self._take(asked, dict(zip(state.name, state.position, strict=False)), "")
        else:
            reason = answer.error_code.message or f"error code {answer.error_code.val}"
            self._take(asked, None, f"The tip cannot be there: {reason}")
        self.ask()
