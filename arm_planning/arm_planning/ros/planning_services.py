"""The services that plan, and those about single states and the planners."""

import logging
from collections.abc import Sequence
from typing import Any

from geometry_msgs.msg import PoseStamped
from moveit_msgs.msg import (
    ConstraintEvalResult,
    ContactInformation,
    PlannerInterfaceDescription,
)
from moveit_msgs.srv import (
    GetCartesianPath,
    GetMotionPlan,
    GetPositionFK,
    GetPositionIK,
    GetStateValidity,
    QueryPlannerInterfaces,
)
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.node import Node

from arm_planning.collision.contact import CollisionContact
from arm_planning.errors import InvalidLinkError, MoveItErrorCode, PlanningError
from arm_planning.pipeline import Timing
from arm_planning.planner import Planner, TimedCartesianPath, pipelines
from arm_planning.planners.cartesian import JumpLimits
from arm_planning.ros.answering import BusyLimit, QuickServices, offer_service
from arm_planning.ros.convert import (
    error_code,
    pose_message,
    pose_of,
    robot_state_message,
    seconds,
    trajectory_message,
    vector_message,
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
        scene = session.state(request.start_state)
        with session.planner() as planner:
            result = self._straight(request, scene, planner)
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
            origin = frames.placed(*frames.reference(frame))
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


class StateServices:
    """Serves compute_ik, compute_fk and check_state_validity; several threads spin the node."""

    def __init__(
        self, node: Node, session: PlanningSession, limit: BusyLimit, quick: QuickServices
    ) -> None:
        self._node = node
        self._session = session
        group = ReentrantCallbackGroup()
        offer_service(node, GetPositionIK, "compute_ik", self._inverse, group=group, limit=limit)
        offer_service(node, GetPositionFK, "compute_fk", self._forward, group=quick)
        offer_service(node, GetStateValidity, "check_state_validity", self._validity, group=quick)

    def _inverse(self, request: Any, answer: GetPositionIK.Response) -> GetPositionIK.Response:
        try:
            with self._session.planner() as planner:
                positions = self._solve(request.ik_request, planner)
        except PlanningError as error:
            LOGGER.info("compute_ik: %s", error)
            answer.error_code = error_code(error.code, str(error))
            return answer
        answer.solution = robot_state_message(self._session.model, positions)
        answer.error_code = error_code(MoveItErrorCode.SUCCESS)
        return answer

    def _solve(self, request: Any, planner: Planner) -> dict[str, float]:
        session = self._session
        scene = session.state(request.robot_state)
        frames = session.frames(scene)
        stamped, link = request.pose_stamped, request.ik_link_name
        if len(request.pose_stamped_vector) == 1:
            stamped = request.pose_stamped_vector[0]
            link = request.ik_link_names[0] if request.ik_link_names else link
        elif request.pose_stamped_vector:
            raise InvalidLinkError(
                f"{len(request.pose_stamped_vector)} poses at once; one link has one pose"
            )
        origin = frames.placed(*frames.reference(stamped.header.frame_id))
        return planner.inverse(
            request.group_name,
            origin.then(pose_of(stamped.pose, "the goal")),
            link=frames.link_and_offset(link) if link else None,
            timeout_s=seconds(request.timeout),
            avoids_collisions=request.avoid_collisions,
            constraints=constraints_of(request.constraints, frames, LOGGER.warning),
            scene=scene,
        )

    def _forward(self, request: Any, answer: GetPositionFK.Response) -> GetPositionFK.Response:
        session = self._session
        if not request.fk_link_names:
            raise InvalidLinkError("compute_fk names no links in fk_link_names")
        frames = session.frames(session.state(request.robot_state))
        base = frames.placed(*frames.reference(request.header.frame_id))
        answer.error_code = error_code(MoveItErrorCode.SUCCESS)
        for name in request.fk_link_names:
            try:
                pose = frames.placed(*frames.link_and_offset(name))
            except PlanningError as error:
                answer.error_code = error_code(error.code, str(error))
                continue
            stamped = PoseStamped(pose=pose_message(base.inverse().then(pose)))
            stamped.header.frame_id = request.header.frame_id or session.model.frame
            stamped.header.stamp = self._node.get_clock().now().to_msg()
            answer.pose_stamped = [*answer.pose_stamped, stamped]
            answer.fk_link_names = [*answer.fk_link_names, name]
        return answer

    def _validity(self, request: Any, answer: GetStateValidity.Response) -> Any:
        session = self._session
        scene = session.state(request.robot_state)
        constraints = constraints_of(request.constraints, session.frames(scene), LOGGER.warning)
        with session.planner() as planner:
            contacts = planner.contacts(request.group_name, scene)
            evaluated = planner.evaluate(constraints, scene)
        answer.valid = not contacts and all(each.satisfied for each in evaluated)
        answer.contacts = [self._contact(contact) for contact in contacts]
        answer.constraint_result = [
            ConstraintEvalResult(result=each.satisfied, distance=each.distance)
            for each in evaluated
        ]
        return answer

    def _contact(self, contact: CollisionContact) -> ContactInformation:
        message = ContactInformation(
            depth=contact.depth_m,
            contact_body_1=contact.first,
            body_type_1=int(contact.first_kind),
            contact_body_2=contact.second,
            body_type_2=int(contact.second_kind),
            normal=vector_message(contact.normal),
        )
        message.header.frame_id = self._session.model.frame
        message.position.x, message.position.y, message.position.z = contact.position
        return message
