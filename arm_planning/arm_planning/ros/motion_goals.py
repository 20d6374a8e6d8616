"""Goals that plan and move: plan, execute, watch, plan again, cancel; and single motions."""

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

from moveit_msgs.action import ExecuteTrajectory, MoveGroup
from rclpy.node import Node

from arm_planning.errors import MoveItErrorCode, PlanningError
from arm_planning.ros.convert import robot_state_message, trajectory_message, trajectory_of
from arm_planning.ros.goals import GoalServer, ServedGoal, Turns
from arm_planning.ros.plan_display import PlanDisplay
from arm_planning.ros.planning_session import PlanningSession
from arm_planning.ros.trajectory_executor import ExecutionManager, ExecutionOutcome
from arm_planning.scene.scene import PlanningScene
from arm_planning.trajectory import TimedTrajectory

DEFAULT_REPLANS = 5
"""Attempts of a goal that asks to replan and gives no number."""
PLANS = 4
"""Goals that only plan, at the same time."""
MOST_EXECUTIONS = 8
"""Goals of execute_trajectory at a time: all but one fail at once, and a few may be ending."""
INVALIDATED = MoveItErrorCode.MOTION_PLAN_INVALIDATED_BY_ENVIRONMENT_CHANGE
RETRIED = (MoveItErrorCode.PLANNING_FAILED, MoveItErrorCode.INVALID_MOTION_PLAN, INVALIDATED)
"""Failures after which another attempt may succeed."""
Plan = tuple[ExecutionOutcome, Sequence[TimedTrajectory]]


@dataclass(frozen=True, slots=True)
class MotionGoals:
    """What the actions move_action and sequence_move_group have in common.

    Attributes:
        session: plans in the present scene.
        executor: moves the robot.
        display: shows plans.
        allows_execution: false for planning alone.
        moving: turns of the goals that move the robot: one after the other.
        planning: turns of those that only plan; they wait for no motion.
    """

    session: PlanningSession
    executor: ExecutionManager
    display: PlanDisplay
    allows_execution: bool
    moving: Turns
    planning: Turns

    def turns_of(self, request: Any) -> Turns:
        """Return the turns that the message of a goal takes."""
        return self.moving if self.moves(request) else self.planning

    def moves(self, request: Any) -> bool:
        """Return whether the message of a goal asks for a motion, and one is allowed."""
        return self.allows_execution and not request.planning_options.plan_only

    def serve(self, goal: ServedGoal, plan: Callable[[], Plan]) -> ExecutionOutcome:
        """Plan; then move, and plan again where the goal asks for it and the first plan is no use.

        `plan` makes a plan, fills the result with it, and tells how it went.
        """
        options = goal.request.planning_options
        moves = self.moves(goal.request)
        replans = options.replan_attempts if options.replan_attempts > 0 else DEFAULT_REPLANS
        attempts = replans if options.replan and moves else 1
        outcome = ExecutionOutcome(MoveItErrorCode.PLANNING_FAILED)
        for _ in range(attempts):
            goal.say("PLANNING")
            planned_in = self.session.monitor.scene
            outcome, trajectories = plan()
            if outcome.code is MoveItErrorCode.SUCCESS and moves:
                goal.say("MONITOR")
                goal.has_moved = True
                remarks = outcome.message
                outcome = self._run(goal, trajectories, planned_in)
                outcome = replace(outcome, message=outcome.message or remarks)
            outcome = goal.ending(outcome)
            if outcome.code not in RETRIED:
                break
            if outcome.code is INVALIDATED:
                goal.wait(options.replan_delay)
        return outcome

    def _run(
        self, goal: ServedGoal, trajectories: Sequence[TimedTrajectory], planned_in: PlanningScene
    ) -> ExecutionOutcome:
        outcome = ExecutionOutcome(MoveItErrorCode.SUCCESS)
        for trajectory in trajectories:
            watch = self.session.watch(trajectory, planned_in)
            outcome = self.executor.execute(trajectory, (), watch, goal.is_interrupted)
            if outcome.code is not MoveItErrorCode.SUCCESS:
                break
        return outcome


class MoveActions:
    """Serves move_action and execute_trajectory; one goal at a time moves the robot."""

    def __init__(self, node: Node, motions: MotionGoals) -> None:
        """Offer the actions; several threads must spin the node."""
        self._motions = motions
        self.executions = Turns(MOST_EXECUTIONS)
        self._move = GoalServer(node, MoveGroup, "move_action", self._serve_move, motions.turns_of)
        self._execute = GoalServer(
            node,
            ExecuteTrajectory,
            "execute_trajectory",
            self._serve_execute,
            lambda _: self.executions,
        )

    def _serve_move(self, goal: ServedGoal, result: MoveGroup.Result) -> ExecutionOutcome:
        started_s = time.monotonic()
        outcome = self._motions.serve(goal, lambda: self._plan(goal, result))
        if goal.has_moved:
            result.executed_trajectory = result.planned_trajectory
        result.planning_time = result.planning_time or time.monotonic() - started_s
        return outcome

    def _plan(self, goal: ServedGoal, result: MoveGroup.Result) -> Plan:
        session = self._motions.session
        response = session.plan(
            goal.request.request,
            goal.request.planning_options.planning_scene_diff,
            from_present=self._motions.moves(goal.request),
            interrupted=goal.is_interrupted,
        )
        found = () if response.trajectory is None else (response.trajectory,)
        result.trajectory_start = robot_state_message(session.model, response.start)
        result.planned_trajectory = trajectory_message(session.model.frame, response.trajectory)
        result.planning_time = response.planning_time_s
        self._motions.display.show(response.start, found)
        return ExecutionOutcome(response.code, response.message), found

    def _serve_execute(
        self, goal: ServedGoal, _result: ExecuteTrajectory.Result
    ) -> ExecutionOutcome:
        goal.say("MONITOR")
        if not self._motions.allows_execution:
            return ExecutionOutcome(
                MoveItErrorCode.CONTROL_FAILED,
                "allow_trajectory_execution is false: this node only plans",
            )
        try:
            trajectory = trajectory_of(goal.request.trajectory)
        except PlanningError as error:
            return ExecutionOutcome(error.code, str(error))
        names = tuple(goal.request.controller_names)
        execute = self._motions.executor.execute
        return goal.ending(execute(trajectory, names, None, goal.is_interrupted))
