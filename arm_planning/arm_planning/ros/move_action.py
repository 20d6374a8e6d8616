"""The actions move_action and execute_trajectory."""

import time

from moveit_msgs.action import ExecuteTrajectory, MoveGroup
from rclpy.node import Node

from arm_planning.errors import MoveItErrorCode, PlanningError
from arm_planning.ros.convert import robot_state_message, trajectory_message, trajectory_of
from arm_planning.ros.goals import GoalServer, ServedGoal, Turns
from arm_planning.ros.motion_goals import MotionGoals, Plan
from arm_planning.ros.trajectory_executor import ExecutionOutcome

MOST_EXECUTIONS = 8
"""Goals of execute_trajectory at a time: all but one fail at once, and a few may be ending."""


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
