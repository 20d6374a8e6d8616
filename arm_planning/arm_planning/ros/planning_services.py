"""The services that plan, and those about the planners."""

import logging
from collections.abc import Sequence
from typing import Any

from moveit_msgs.msg import PlannerInterfaceDescription, RobotTrajectory
from moveit_msgs.srv import (
    GetCartesianPath,
    GetMotionPlan,
    QueryPlannerInterfaces,
)
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.node import Node

from arm_planning.errors import MoveItErrorCode, PlanningError
from arm_planning.pipeline import Timing
from arm_planning.planner import Planner, TimedCartesianPath, pipelines
from arm_planning.planners.cartesian import JumpLimits
from arm_planning.ros.answering import BusyLimit, offer_service
from arm_planning.ros.convert import (
    error_code,
    pose_of,
    robot_state_message,
    trajectory_message,
)
from arm_planning.ros.convert_constraints import constraints_of
from arm_planning.ros.plan_display import PlanDisplay
from arm_planning.ros.planning_session import PlanningSession
from arm_planning.scene.scene import PlanningScene

LOGGER = logging.getLogger("move_group")


class PlanningServices:
    """Serves plan_kinematic_path, compute_cartesian_path and the queries about planners."""

    def __init__(
        self, node: Node, session: PlanningSession, display: PlanDisplay, limit: BusyLimit
    ) -> None:
        """Offer the services, those that plan with a limit; several threads must spin the node."""
        self._session = session
        self._display = display
        group = ReentrantCallbackGroup()
        for kind, name, serve in (
            (GetMotionPlan, "plan_kinematic_path", self._plan),
            (GetCartesianPath, "compute_cartesian_path", self._cartesian),
        ):
            offer_service(node, kind, name, serve, group=group, limit=limit)
        offer_service(
            node, QueryPlannerInterfaces, "query_planner_interface", self._planners, group=group
        )

    def _plan(self, request: Any, answer: GetMotionPlan.Response) -> GetMotionPlan.Response:
        response = self._session.plan(request.motion_plan_request)
        model = self._session.model
        filled = answer.motion_plan_response
        filled.group_name = request.motion_plan_request.group_name
        filled.trajectory_start = robot_state_message(model, response.start)
        filled.trajectory = trajectory_message(model.frame, response.trajectory)
        filled.planning_time = response.planning_time_s
        filled.error_code = error_code(response.code, response.message)
        if response.trajectory is None:
            LOGGER.error("%s: %s", response.code.name, response.message)
        else:
            self._display.show(response.start, [response.trajectory])
        return answer

    def _cartesian(self, request: Any, answer: GetCartesianPath.Response) -> Any:
        session = self._session
        try:
            scene = session.state(request.start_state)
            with session.planner() as planner:
                result = self._straight(request, scene, planner)
        except PlanningError as error:
            LOGGER.error("compute_cartesian_path: %s", error)
            answer.error_code = error_code(error.code, str(error))
            answer.solution = RobotTrajectory()
            return answer
        answer.start_state = robot_state_message(session.model, scene.positions)
        answer.solution = trajectory_message(session.model.frame, result.trajectory)
        answer.fraction = result.fraction
        answer.error_code = error_code(MoveItErrorCode.SUCCESS, result.stopped)
        if result.stopped:
            LOGGER.warning("%s", result.stopped)
        self._display.show(scene.positions, [result.trajectory])
        return answer

    def _straight(self, request: Any, scene: PlanningScene, planner: Planner) -> TimedCartesianPath:
        session = self._session
        frames = session.frames(scene)
        poses = [pose_of(pose, f"way point {i}") for i, pose in enumerate(request.waypoints, 1)]
        frame = request.header.frame_id.lstrip("/")
        relative = bool(frame) and frame == request.link_name
        if not relative:
            mover, origin = frames.reference(frame)
            if mover:
                origin = planner.link_pose(mover, scene).then(origin)
            poses = [origin.then(pose) for pose in poses]
        return planner.cartesian_path(
            request.group_name,
            poses,
            max_step_m=request.max_step,
            link=request.link_name,
            relative=relative,
            jumps=JumpLimits(
                request.jump_threshold,
                request.revolute_jump_threshold,
                request.prismatic_jump_threshold,
            ),
            avoids_collisions=request.avoid_collisions,
            path=constraints_of(request.path_constraints, frames, LOGGER.warning),
            timing=Timing(
                request.max_velocity_scaling_factor, request.max_acceleration_scaling_factor
            ),
            scene=scene,
        )

    def _planners(self, _request: Any, answer: QueryPlannerInterfaces.Response) -> Any:
        answer.planner_interfaces = [
            PlannerInterfaceDescription(
                name=title, pipeline_id=pipeline, planner_ids=self._ids(planners)
            )
            for pipeline, (title, planners) in pipelines().items()
        ]
        return answer

    def _ids(self, planners: Sequence[str]) -> list[str]:
        """Return planners' ids as MoveIt's: each alone, and for each group, as RViz lists them."""
        groups = self._session.model.groups
        return [*planners, *groups, *(f"{group}[{name}]" for group in groups for name in planners)]
