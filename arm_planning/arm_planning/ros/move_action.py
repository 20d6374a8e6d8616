"""The actions move_action and execute_trajectory: plan, execute, watch, replan, cancel."""

import logging
import threading
import time
from collections.abc import Callable
from typing import Any

from moveit_msgs.action import ExecuteTrajectory, MoveGroup
from rclpy.action.server import ActionServer, CancelResponse, GoalResponse, ServerGoalHandle
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.node import Node

from arm_planning.errors import ErrorCode, PlanningError
from arm_planning.request import PlanResponse
from arm_planning.ros.convert import (
    error_code,
    robot_state_message,
    trajectory_message,
    trajectory_of,
)
from arm_planning.ros.planning_session import PlanningSession
from arm_planning.ros.trajectory_executor import Outcome, TrajectoryExecutor

RESULT_TIMEOUT_S = 60
"""How long a result is kept for its client; rclpy's 15 minutes would fill the memory."""
DEFAULT_REPLANS = 5
RETRIED = (ErrorCode.PLANNING_FAILED, ErrorCode.INVALID_MOTION_PLAN)
"""Failures of planning after which another attempt may succeed."""
LOGGER = logging.getLogger("move_group")


class MoveActions:
    """Serves move_action and execute_trajectory; one goal at a time moves the robot."""

    def __init__(
        self,
        node: Node,
        session: PlanningSession,
        executor: TrajectoryExecutor,
        allows_execution: bool,
    ) -> None:
        """Offer the actions; several threads must spin the node.

        Args:
            node: gets the action servers.
            session: plans in the present scene.
            executor: moves the robot.
            allows_execution: false for planning alone.
        """
        self._session = session
        self._executor = executor
        self._allows_execution = allows_execution
        self._one_at_a_time = threading.Lock()
        group = ReentrantCallbackGroup()
        self._move = _server(node, MoveGroup, "move_action", self._serve_move, self._cancel, group)
        self._execute = _server(
            node,
            ExecuteTrajectory,
            "execute_trajectory",
            self._serve_execute,
            self._cancel,
            group,
        )

    def _cancel(self, _goal: Any) -> CancelResponse:
        return CancelResponse.ACCEPT

    def _serve_move(self, goal: ServerGoalHandle) -> MoveGroup.Result:
        feedback = _Feedback(goal, MoveGroup.Feedback)
        with self._one_at_a_time:
            result = MoveGroup.Result()
            started_s = time.monotonic()
            feedback.say("PLANNING")
            options = goal.request.planning_options
            plans_only = options.plan_only or not self._allows_execution
            if goal.is_cancel_requested:
                outcome = Outcome(ErrorCode.PREEMPTED, "the request was cancelled")
            elif plans_only:
                outcome = self._plan_only(goal, result)
            else:
                outcome = self._plan_and_execute(goal, result, feedback)
            result.planning_time = result.planning_time or time.monotonic() - started_s
            result.error_code = error_code(outcome.code, outcome.message)
        _finish(goal, outcome)
        feedback.say("IDLE")
        return result

    def _plan_only(self, goal: ServerGoalHandle, result: MoveGroup.Result) -> Outcome:
        request = goal.request
        response = self._session.plan(request.request, request.planning_options.planning_scene_diff)
        self._fill(result, response)
        return Outcome(response.code, response.message)

    def _plan_and_execute(
        self, goal: ServerGoalHandle, result: MoveGroup.Result, feedback: "_Feedback"
    ) -> Outcome:
        options = goal.request.planning_options
        attempts = (options.replan_attempts or DEFAULT_REPLANS) if options.replan else 1
        outcome = Outcome(ErrorCode.PLANNING_FAILED)
        for attempt in range(attempts):
            if attempt:
                feedback.say("PLANNING")
            response = self._session.plan_from_present(
                goal.request.request, options.planning_scene_diff
            )
            self._fill(result, response)
            outcome = Outcome(response.code, response.message)
            if response.trajectory is not None:
                feedback.say("MONITOR")
                outcome = self._run(goal, response, ())
                result.executed_trajectory = result.planned_trajectory
            if goal.is_cancel_requested:
                return Outcome(ErrorCode.PREEMPTED, "the request was cancelled")
            if outcome.code is ErrorCode.MOTION_PLAN_INVALIDATED_BY_ENVIRONMENT_CHANGE:
                time.sleep(max(options.replan_delay, 0.0))
            elif outcome.code not in RETRIED:
                break
        return outcome

    def _run(
        self, goal: ServerGoalHandle, response: PlanResponse, names: tuple[str, ...]
    ) -> Outcome:
        trajectory = response.trajectory
        assert trajectory is not None
        watch = self._session.watch(trajectory)

        def blocked(elapsed_s: float) -> str:
            if goal.is_cancel_requested:
                self._executor.stop()
            return watch(elapsed_s)

        return self._executor.execute(trajectory, names, blocked)

    def _fill(self, result: MoveGroup.Result, response: PlanResponse) -> None:
        model = self._session.model
        result.trajectory_start = robot_state_message(model, response.start)
        result.planned_trajectory = trajectory_message(model.frame, response.trajectory)
        result.planning_time = response.planning_time_s

    def _serve_execute(self, goal: ServerGoalHandle) -> ExecuteTrajectory.Result:
        feedback = _Feedback(goal, ExecuteTrajectory.Feedback)
        feedback.say("MONITOR")
        outcome = self._execute_given(goal)
        _finish(goal, outcome)
        feedback.say("IDLE")
        return ExecuteTrajectory.Result(error_code=error_code(outcome.code, outcome.message))

    def _execute_given(self, goal: ServerGoalHandle) -> Outcome:
        if not self._allows_execution:
            return Outcome(
                ErrorCode.CONTROL_FAILED,
                "allow_trajectory_execution is false: this node only plans",
            )

        def cancelled(_elapsed_s: float) -> str:
            if goal.is_cancel_requested:
                self._executor.stop()
            return ""

        try:
            trajectory = trajectory_of(goal.request.trajectory)
        except PlanningError as error:
            return Outcome(error.code, str(error))
        return self._executor.execute(trajectory, tuple(goal.request.controller_names), cancelled)


class _Feedback:
    """Publishes the states of a goal: PLANNING, MONITOR, IDLE."""

    def __init__(self, goal: ServerGoalHandle, message: type[Any]) -> None:
        self._goal = goal
        self._message = message

    def say(self, state: str) -> None:
        self._goal.publish_feedback(self._message(state=state))


def _finish(goal: ServerGoalHandle, outcome: Outcome) -> None:
    """Give a goal its status: succeeded, canceled or aborted; log the reason of a failure."""
    if outcome.code is ErrorCode.SUCCESS:
        if outcome.message:
            LOGGER.info("%s", outcome.message)
        goal.succeed()
        return
    LOGGER.error("%s: %s", outcome.code.name, outcome.message)
    if outcome.code is ErrorCode.PREEMPTED and goal.is_cancel_requested:
        goal.canceled()
    else:
        goal.abort()


def _server(
    node: Node,
    action: type[Any],
    name: str,
    serve: Callable[[ServerGoalHandle], Any],
    cancel: Callable[[Any], CancelResponse],
    group: ReentrantCallbackGroup,
) -> ActionServer:
    return ActionServer(
        node,
        action,
        name,
        serve,
        callback_group=group,
        goal_callback=lambda _: GoalResponse.ACCEPT,
        cancel_callback=cancel,
        result_timeout=RESULT_TIMEOUT_S,
    )
