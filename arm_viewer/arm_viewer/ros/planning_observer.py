"""Observe move_groups in any namespace: the robots that motions can be planned for."""

import logging
from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING

from rclpy.node import Node
from std_msgs.msg import String

from arm_description.urdf.robot import Robot
from arm_node.polled_subscriptions import PolledSubscriptions
from arm_node.qos import LATCHED
from arm_viewer.requests import PlanningRequest
from arm_viewer.ros.observer import Observer, TopicTypes, served
from arm_viewer.ros.topic_reader import TopicGroup
from arm_viewer.snapshot import SimulationTime, Snapshot

if TYPE_CHECKING:
    from arm_viewer.planning import PlanningView
    from arm_viewer.ros.observed_move_group import ObservedMoveGroup

SERVICE = "/move_action/_action/send_goal"
SERVICE_TYPE = "moveit_msgs/action/MoveGroup_SendGoal"
SEMANTIC = "robot_description_semantic"
_logger = logging.getLogger(__name__)


class PlanningObserver(Observer):
    """Keeps a client of each move_group whose robot is known.

    Without the package moveit_msgs it finds nothing. It and planning's code are imported with the
    first move_group.
    """

    def __init__(
        self,
        node: Node,
        polled: PolledSubscriptions,
        latest: Callable[[], Snapshot],
        clock: Callable[[], SimulationTime | None],
    ) -> None:
        """Observe the robots of the latest snapshot, which live in the time of a clock, if any."""
        self._node = node
        self._polled = polled
        self._latest = latest
        self._clock = clock
        self._topics = TopicGroup(node, polled, String, SEMANTIC, LATCHED)
        self._texts: dict[str, str] = {}
        self._clients: dict[str, ObservedMoveGroup] = {}
        self._made_from: dict[str, tuple[Robot, str]] = {}

    @property
    def views(self) -> "Mapping[str, PlanningView]":
        """The move_groups by namespace."""
        return MappingProxyType({name: client.view for name, client in self._clients.items()})

    def discover(self, topics: TopicTypes) -> None:
        """Look for move_groups; forget those that have disappeared."""
        self._topics.discover(topics)
        found = served(self._node, SERVICE, SERVICE_TYPE)
        for client in self._clients.values():
            client.check()
        for namespace in self._clients.keys() - found:
            self._close(namespace)
        for namespace in sorted(found):
            self._renew(namespace)

    def collect(self, now_s: float) -> None:
        """Take what has arrived."""
        for reader in self._topics.readers():
            message = reader.take_newest()
            if message is not None:
                self._texts[reader.topic.removesuffix(f"/{SEMANTIC}")] = message.data
        for client in self._clients.values():
            client.collect()

    def serve(self, request: PlanningRequest) -> None:
        """Pass a request to its move_group."""
        client = self._clients.get(request.namespace)
        if client is not None:
            client.serve(request)

    def _close(self, namespace: str) -> None:
        self._clients.pop(namespace).close()
        del self._made_from[namespace]

    def _renew(self, namespace: str) -> None:
        """Make the client of a move_group, anew if its robot has changed."""
        described = self._latest().descriptions.get(f"{namespace}/robot_description")
        text = self._texts.get(namespace)
        if described is None or described.robot is None or text is None:
            return
        known = self._made_from.get(namespace)
        if known is not None and known[0] is described.robot and known[1] == text:
            return
        if namespace in self._clients:
            self._close(namespace)
        client = self._client(namespace, described.robot, text)
        if client is not None:
            self._clients[namespace] = client
        self._made_from[namespace] = (described.robot, text)

    def _client(self, namespace: str, robot: Robot, text: str) -> "ObservedMoveGroup | None":
        try:
            from arm_planning.errors import PlanningError, SrdfError
            from arm_planning.robot.build import planning_model
            from arm_planning.robot.srdf import parse_srdf
            from arm_viewer.ros.observed_move_group import ObservedMoveGroup
        except ImportError as error:
            _logger.warning("motions are not shown: %s", error)
            return None
        try:
            # The limits do not matter here, so neither do remarks about them.
            srdf = parse_srdf(text, robot, f"{namespace}/{SEMANTIC}")
            model = planning_model(robot, srdf, warn=lambda _: None)
        except (PlanningError, SrdfError) as error:
            _logger.warning("motions of %s are not shown: %s", namespace or "/", error)
            return None
        return ObservedMoveGroup(
            self._node,
            self._polled,
            namespace,
            model,
            lambda: self._latest().positions(namespace),
            self._clock,
        )
