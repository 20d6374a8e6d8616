"""The action sequence_move_group and the service plan_sequence_path: Pilz' sequences."""

import logging
import time
from collections.abc import Sequence
from typing import Any

from moveit_msgs.action import MoveGroupSequence
from moveit_msgs.srv import GetMotionSequence
from rclpy.action.server import ServerGoalHandle
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.node import Node

from arm_planning.errors import MoveItErrorCode
from arm_planning.ros.convert import error_code
from arm_planning.ros.goals import (
    CANCELLED,
    DEFAULT_REPLANS,
    GoalFeedback,
    Turns,
    action_server,
    cancellable,
    finish,
)
from arm_planning.ros.plan_display import PlanDisplay
from arm_planning.ros.sequence_session import SequenceSession
from arm_planning.ros.trajectory_executor import ExecutionManager, ExecutionOutcome
from arm_planning.scene.scene import PlanningScene
from arm_planning.trajectory import TimedTrajectory

LOGGER = logging.getLogger("move_group")


class SequenceServer:
    """Plans sequences, and runs their trajectories one after the other."""

    def __init__(
        self,
        node: Node,
        sequences: SequenceSession,
        executor: ExecutionManager,
        display: PlanDisplay,
        turns: Turns,
        *,
        allows_execution: bool,
    ) -> None:
        """Offer the action and the service; several threads must spin the node.

        Args:
            node: gets the servers.
            sequences: plans in the present scene.
            executor: moves the robot.
            display: shows plans.
            turns: of the goals that plan and move.
            allows_execution: false for planning alone.
        """
        self._sequences = sequences
        self._executor = executor
        self._display = display
        self._allows_execution = allows_execution
        group = ReentrantCallbackGroup()
        self._action = action_server(
            node, MoveGroupSequence, "sequence_move_group", self._serve, group, turns
        )
        node.create_service(
            GetMotionSequence, "plan_sequence_path", self._serve_plan, callback_group=group
        )

    def _serve_plan(self, request: Any, answer: GetMotionSequence.Response) -> Any:
        plan = self._sequences.plan(request.request)
        if plan.code is not MoveItErrorCode.SUCCESS:
            LOGGER.error("%s: %s", plan.code.name, plan.message)
        self._display.show(plan.start, plan.trajectories)
        answer.response = plan.message_of(self._sequences.session.model)
        return answer

    def _serve(self, goal: ServerGoalHandle) -> MoveGroupSequence.Result:
        feedback = GoalFeedback(goal, MoveGroupSequence.Feedback)
        result = MoveGroupSequence.Result()
        options = goal.request.planning_options
        executes = self._allows_execution and not options.plan_only
        attempts = (options.replan_attempts or DEFAULT_REPLANS) if options.replan else 1
        outcome = CANCELLED
        for _ in range(attempts if executes else 1):
            if goal.is_cancel_requested:
                outcome = CANCELLED
                break
            outcome = self._attempt(goal, result, feedback, executes=executes)
            if outcome.code is not MoveItErrorCode.MOTION_PLAN_INVALIDATED_BY_ENVIRONMENT_CHANGE:
                break
            time.sleep(max(options.replan_delay, 0.0))
        result.response.error_code = error_code(outcome.code, outcome.message)
        finish(goal, outcome)
        feedback.say("IDLE")
        return result

    def _attempt(
        self,
        goal: ServerGoalHandle,
        result: MoveGroupSequence.Result,
        feedback: GoalFeedback,
        *,
        executes: bool,
    ) -> ExecutionOutcome:
        feedback.say("PLANNING")
        request = goal.request
        planned_in = self._sequences.session.monitor.scene
        plan = self._sequences.plan(
            request.request, request.planning_options.planning_scene_diff, from_present=executes
        )
        result.response = plan.message_of(self._sequences.session.model)
        self._display.show(plan.start, plan.trajectories)
        if plan.code is not MoveItErrorCode.SUCCESS or not executes:
            return ExecutionOutcome(plan.code, plan.message)
        feedback.say("MONITOR")
        return self._run(goal, plan.trajectories, planned_in)

    def _run(
        self,
        goal: ServerGoalHandle,
        trajectories: Sequence[TimedTrajectory],
        planned_in: PlanningScene,
    ) -> ExecutionOutcome:
        for trajectory in trajectories:
            if goal.is_cancel_requested:
                return CANCELLED
            blocked = self._sequences.session.watch(trajectory, planned_in)
            watch = cancellable(goal, self._executor, blocked)
            outcome = self._executor.execute(trajectory, (), watch)
            if outcome.code is not MoveItErrorCode.SUCCESS:
                return CANCELLED if goal.is_cancel_requested else outcome
        return ExecutionOutcome(MoveItErrorCode.SUCCESS)
