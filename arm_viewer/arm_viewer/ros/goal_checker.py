"""Asks one move_group what touches what at the goal."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

from moveit_msgs.msg import RobotState
from moveit_msgs.srv import GetStateValidity
from rclpy.node import Node

from arm_planning.collision.contact import BodyKind, CollisionContact
from arm_planning.robot.model import JointPositions
from arm_viewer.planning import GoalState
from arm_viewer.ros.service_caller import ServiceCaller


def state_message(positions: JointPositions) -> RobotState:
    """Return a state that differs from the present one in these joints."""
    state = RobotState(is_diff=True)
    state.joint_state.name = list(positions)
    state.joint_state.position = [float(position) for position in positions.values()]
    return state


class GoalChecker:
    """Checks the latest goal, one at a time. Use it in the executor's thread."""

    def __init__(self, node: Node, namespace: str, take: Callable[[GoalState], None]) -> None:
        """Create the client; `take` receives each checked goal with its contacts."""
        self._service = ServiceCaller(node, GetStateValidity, f"{namespace}/check_state_validity")
        self._take = take
        self._waiting: GoalState | None = None

    def check(self, goal: GoalState) -> None:
        """Check a goal as soon as the one before is answered; the latest one wins."""
        self._waiting = goal
        self.ask()

    def ask(self) -> None:
        """Ask if the service is free; call it periodically."""
        goal = self._waiting
        if goal is None:
            return
        request = GetStateValidity.Request(
            robot_state=state_message(goal.positions), group_name=goal.group
        )
        if self._service.ask(request, lambda answer: self._answer(goal, answer)):
            self._waiting = None

    def close(self) -> None:
        """Destroy the client."""
        self._service.close()

    def _answer(self, goal: GoalState, answer: GetStateValidity.Response) -> None:
        contacts = [_contact(message) for message in answer.contacts]
        links = {
            name
            for each in contacts
            for name, kind in ((each.first, each.first_kind), (each.second, each.second_kind))
            if kind is BodyKind.ROBOT_LINK
        }
        lines = tuple(map(str, contacts))
        self._take(replace(goal, colliding=frozenset(links), contacts=lines))
        self.ask()


def _contact(message: Any) -> CollisionContact:
    position, normal = message.position, message.normal
    return CollisionContact(
        message.contact_body_1,
        message.contact_body_2,
        BodyKind(message.body_type_1),
        BodyKind(message.body_type_2),
        message.depth,
        (position.x, position.y, position.z),
        (normal.x, normal.y, normal.z),
    )
