"""The actions move_action and execute_trajectory: plan, execute, watch, replan, cancel."""

import logging
import time

from moveit_msgs.action import ExecuteTrajectory, MoveGroup
from rclpy.action.server import ServerGoalHandle
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.node import Node

from arm_planning.errors import MoveItErrorCode, PlanningError
from arm_planning.request import PlanResponse
from arm_planning.ros.convert import (
    error_code,
    robot_state_message,
    trajectory_message,
    trajectory_of,
)
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
from arm_planning.ros.planning_session import PlanningSession
from arm_planning.ros.trajectory_executor import ExecutionManager, ExecutionOutcome
from arm_planning.scene.scene import PlanningScene
from arm_planning.trajectory import TimedTrajectory

RETRIED = (MoveItErrorCode.PLANNING_FAILED, MoveItErrorCode.INVALID_MOTION_PLAN)
"""Failures of planning after which another attempt may succeed."""
LOGGER = logging.getLogger("move_group")


class MoveActions:
    """Serves move_action and execute_trajectory; one goal at a time moves the robot."""

    def __init__(
        self,
        node: Node,
        session: PlanningSession,
        executor: ExecutionManager,
        display: PlanDisplay,
        turns: Turns,
        *,
        allows_execution: bool,
    ) -> None:
        """Offer the actions; several threads must spin the node.

        Args:
            node: gets the action servers.
            session: plans in the present scene.
            executor: moves the robot.
            display: shows plans.
            turns: of the goals that plan and move.
            allows_execution: false for planning alone.
        """
        self._session = session
        self._executor = executor
        self._allows_execution = allows_execution
        self._display = display
        group = ReentrantCallbackGroup()
        self._move = action_server(node, MoveGroup, "move_action", self._serve_move, group, turns)
        self._execute = action_server(
            node, ExecuteTrajectory, "execute_trajectory", self._serve_execute, group
        )

    def _serve_move(self, goal: ServerGoalHandle) -> MoveGroup.Result:
        feedback = GoalFeedback(goal, MoveGroup.Feedback)
        result = MoveGroup.Result()
        started_s = time.monotonic()
        feedback.say("PLANNING")
        options = goal.request.planning_options
        plans_only = options.plan_only or not self._allows_execution
        if goal.is_cancel_requested:
            outcome = CANCELLED
        elif plans_only:
            outcome = self._plan_only(goal, result)
        else:
            outcome = self._plan_and_execute(goal, result, feedback)
        result.planning_time = result.planning_time or time.monotonic() - started_s
        result.error_code = error_code(outcome.code, outcome.message)
        finish(goal, outcome)
        feedback.say("IDLE")
        return result

    def _plan_only(self, goal: ServerGoalHandle, result: MoveGroup.Result) -> ExecutionOutcome:
        request = goal.request
        response = self._session.plan(request.request, request.planning_options.planning_scene_diff)
        self._fill(result, response)
        return ExecutionOutcome(response.code, response.message)

    def _plan_and_execute(
        self, goal: ServerGoalHandle, result: MoveGroup.Result, feedback: GoalFeedback
    ) -> ExecutionOutcome:
        options = goal.request.planning_options
        attempts = (options.replan_attempts or DEFAULT_REPLANS) if options.replan else 1
        outcome = ExecutionOutcome(MoveItErrorCode.PLANNING_FAILED)
        for attempt in range(attempts):
            if attempt:
                feedback.say("PLANNING")
            planned_in = self._session.monitor.scene
            response = self._session.plan_from_present(
                goal.request.request, options.planning_scene_diff
            )
            self._fill(result, response)
            outcome = ExecutionOutcome(response.code, response.message)
            if response.trajectory is not None:
                feedback.say("MONITOR")
                outcome = self._run(goal, response.trajectory, planned_in)
                result.executed_trajectory = result.planned_trajectory
            if goal.is_cancel_requested:
                return CANCELLED
            if outcome.code is MoveItErrorCode.MOTION_PLAN_INVALIDATED_BY_ENVIRONMENT_CHANGE:
                time.sleep(max(options.replan_delay, 0.0))
            elif outcome.code not in RETRIED:
                break
        return outcome

    def _run(
        self, goal: ServerGoalHandle, trajectory: TimedTrajectory, planned_in: PlanningScene
    ) -> ExecutionOutcome:
        blocked = self._session.watch(trajectory, planned_in)
        watch = cancellable(goal, self._executor, blocked)
        return self._executor.execute(trajectory, (), watch)

    def _fill(self, result: MoveGroup.Result, response: PlanResponse) -> None:
        model = self._session.model
        result.trajectory_start = robot_state_message(model, response.start)
        result.planned_trajectory = trajectory_message(model.frame, response.trajectory)
        result.planning_time = response.planning_time_s
        self._display.show(response.start, [response.trajectory])

    def _serve_execute(self, goal: ServerGoalHandle) -> ExecuteTrajectory.Result:
        feedback = GoalFeedback(goal, ExecuteTrajectory.Feedback)
        feedback.say("MONITOR")
        outcome = self._execute_given(goal)
        finish(goal, outcome)
        feedback.say("IDLE")
        return ExecuteTrajectory.Result(error_code=error_code(outcome.code, outcome.message))

    def _execute_given(self, goal: ServerGoalHandle) -> ExecutionOutcome:
        if not self._allows_execution:
            return ExecutionOutcome(
                MoveItErrorCode.CONTROL_FAILED,
                "allow_trajectory_execution is false: this node only plans",
            )
        try:
            trajectory = trajectory_of(goal.request.trajectory)
        except PlanningError as error:
            return ExecutionOutcome(error.code, str(error))
        watch = cancellable(goal, self._executor, lambda _: "")
        return self._executor.execute(trajectory, tuple(goal.request.controller_names), watch)
