"""The action sequence_move_group and the service plan_sequence_path: Pilz' sequences."""

import logging
from typing import Any

from moveit_msgs.action import MoveGroupSequence
from moveit_msgs.srv import GetMotionSequence
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.node import Node

from arm_planning.errors import MoveItErrorCode
from arm_planning.ros.answering import BusyLimit, offer_service
from arm_planning.ros.goals import GoalServer, ServedGoal
from arm_planning.ros.motion_goals import MotionGoals, Plan
from arm_planning.ros.sequence_session import SequenceSession
from arm_planning.ros.trajectory_executor import ExecutionOutcome

LOGGER = logging.getLogger("move_group")


class SequenceServer:
    """Plans sequences, and runs their trajectories one after the other."""

    def __init__(self, node: Node, motions: MotionGoals, limit: BusyLimit) -> None:
        """Offer the action and the service; several threads must spin the node.

        Args:
            node: gets the servers.
            motions: plans and moves.
            limit: of the services that plan.
        """
        self._motions = motions
        self._sequences = SequenceSession(motions.session)
        self._action = GoalServer(
            node, MoveGroupSequence, "sequence_move_group", self._serve, motions.turns_of
        )
        offer_service(
            node,
            GetMotionSequence,
            "plan_sequence_path",
            self._serve_plan,
            group=ReentrantCallbackGroup(),
            limit=limit,
        )

    def _serve_plan(self, request: Any, answer: GetMotionSequence.Response) -> Any:
        plan = self._sequences.plan(request.request)
        if plan.code is not MoveItErrorCode.SUCCESS:
            LOGGER.error("%s: %s", plan.code.name, plan.message)
        self._motions.display.show(plan.start, plan.trajectories)
        answer.response = plan.message_of(self._motions.session.model)
        return answer

    def _serve(self, goal: ServedGoal, result: MoveGroupSequence.Result) -> ExecutionOutcome:
        return self._motions.serve(goal, lambda: self._plan(goal, result))

    def _plan(self, goal: ServedGoal, result: MoveGroupSequence.Result) -> Plan:
        plan = self._sequences.plan(
            goal.request.request,
            goal.request.planning_options.planning_scene_diff,
            from_present=self._motions.moves(goal.request),
            interrupted=goal.is_interrupted,
        )
        result.response = plan.message_of(self._motions.session.model)
        self._motions.display.show(plan.start, plan.trajectories)
        return ExecutionOutcome(plan.code, plan.message), plan.trajectories
