"""The services about single states: compute_ik, compute_fk, check_state_validity."""

import logging
from typing import Any

from geometry_msgs.msg import PoseStamped
from moveit_msgs.msg import ConstraintEvalResult, ContactInformation
from moveit_msgs.srv import GetPositionFK, GetPositionIK, GetStateValidity
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.node import Node

from arm_node.rigid_transform import RigidTransform
from arm_planning.collision.contact import CollisionContact
from arm_planning.errors import MoveItErrorCode, PlanningError
from arm_planning.planner import Planner
from arm_planning.ros.answering import BusyLimit, offer_service
from arm_planning.ros.convert import (
    error_code,
    pose_message,
    pose_of,
    robot_state_message,
    seconds,
    vector_message,
)
from arm_planning.ros.convert_constraints import constraints_of
from arm_planning.ros.planning_session import PlanningSession
from arm_planning.ros.quick_services import QuickServices
from arm_planning.scene.scene import PlanningScene

LOGGER = logging.getLogger("move_group")


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
            raise PlanningError(
                MoveItErrorCode.INVALID_LINK_NAME,
                f"{len(request.pose_stamped_vector)} poses at once; one link has one pose",
            )
        mover, origin = frames.reference(stamped.header.frame_id)
        if mover:
            origin = planner.link_pose(mover, scene).then(origin)
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
        try:
            if not request.fk_link_names:
                raise PlanningError(
                    MoveItErrorCode.INVALID_LINK_NAME, "compute_fk names no links in fk_link_names"
                )
            scene = session.state(request.robot_state)
            frames = session.frames(scene)
            base = self._pose(scene, *frames.reference(request.header.frame_id))
        except PlanningError as error:
            answer.error_code = error_code(error.code, str(error))
            return answer
        answer.error_code = error_code(MoveItErrorCode.SUCCESS)
        for name in request.fk_link_names:
            try:
                pose = self._pose(scene, *frames.link_and_offset(name))
            except PlanningError as error:
                answer.error_code = error_code(error.code, str(error))
                continue
            stamped = PoseStamped(pose=pose_message(base.inverse().then(pose)))
            stamped.header.frame_id = request.header.frame_id or session.model.frame
            stamped.header.stamp = self._node.get_clock().now().to_msg()
            answer.pose_stamped = [*answer.pose_stamped, stamped]
            answer.fk_link_names = [*answer.fk_link_names, name]
        return answer

    def _pose(self, scene: PlanningScene, link: str, offset: RigidTransform) -> RigidTransform:
        if not link:
            return offset
        with self._session.planner() as planner:
            return planner.link_pose(link, scene).then(offset)

    def _validity(self, request: Any, answer: GetStateValidity.Response) -> Any:
        session = self._session
        try:
            scene = session.state(request.robot_state)
            constraints = constraints_of(request.constraints, session.frames(scene), LOGGER.warning)
            with session.planner() as planner:
                contacts = planner.contacts(request.group_name, scene)
                evaluated = planner.evaluate(constraints, scene)
        except PlanningError as error:
            LOGGER.error("check_state_validity: %s", error)
            answer.valid = False
            return answer
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
