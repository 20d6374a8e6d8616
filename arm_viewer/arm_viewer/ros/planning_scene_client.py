"""Follows and changes the planning scene of one move_group."""

import logging

from moveit_msgs.msg import CollisionObject as ObjectMessage
from moveit_msgs.msg import PlanningScene as SceneMessage
from moveit_msgs.srv import ApplyPlanningScene, GetPlanningScene
from rclpy.node import Node
from rclpy.qos import QoSProfile

from arm_node.polled_subscriptions import PolledSubscriptions
from arm_planning.errors import PlanningError
from arm_planning.robot.model import PlanningModel
from arm_planning.ros.convert_scene import object_message, scene_change_of
from arm_planning.scene.objects import CollisionObject
from arm_planning.scene.scene import PlanningScene
from arm_planning.scene.scene_changes import change_scene
from arm_viewer.ros.service_caller import ServiceCaller
from arm_viewer.ros.topic_reader import TopicReader

_QOS = QoSProfile(depth=100)
_logger = logging.getLogger(__name__)


class PlanningSceneClient:
    """Use it in the executor's thread.

    Attributes:
        scene: the scene; None until it is known.
        problem: why the last change was not possible; empty if it was.
    """

    def __init__(
        self, node: Node, polled: PolledSubscriptions, namespace: str, model: PlanningModel
    ) -> None:
        """Create the clients."""
        self.scene: PlanningScene | None = None
        self.problem = ""
        self._model = model
        self._whole = ServiceCaller(node, GetPlanningScene, f"{namespace}/get_planning_scene")
        self._apply = ServiceCaller(node, ApplyPlanningScene, f"{namespace}/apply_planning_scene")
        self._changes: TopicReader[SceneMessage] = TopicReader(
            node, polled, SceneMessage, f"{namespace}/monitored_planning_scene", _QOS
        )

    def collect(self) -> None:
        """Take changes that have arrived; ask for the whole scene until it is known."""
        if self.scene is None:
            self._whole.ask(GetPlanningScene.Request(), lambda answer: self._take(answer.scene))
        for message in self._changes.take_all():
            if not message.is_diff or (self.scene is not None and _has_objects(message)):
                self._take(message)
        if self._apply.is_overdue():
            self._apply.forget()
            self.problem = f"{self._apply.service} does not answer"

    def add(self, each: CollisionObject) -> None:
        """Add an object, or put it in place of the one with its name."""
        self._change(object_message(each, self._model.frame), f"'{each.id}' was not added")

    def remove(self, name: str) -> None:
        """Remove an object."""
        message = ObjectMessage(id=name, operation=ObjectMessage.REMOVE)
        message.header.frame_id = self._model.frame
        self._change(message, f"'{name}' was not removed")

    def close(self) -> None:
        """Destroy the clients."""
        self._whole.close()
        self._apply.close()
        self._changes.close()

    def _change(self, message: ObjectMessage, failed: str) -> None:
        scene = SceneMessage(is_diff=True)
        scene.robot_state.is_diff = True
        scene.world.collision_objects = [message]

        def take(answer: ApplyPlanningScene.Response) -> None:
            self.problem = "" if answer.success else f"{failed}; move_group's log says why"

        if not self._apply.ask(ApplyPlanningScene.Request(scene=scene), take):
            self.problem = f"{failed}: {self._apply.service} does not answer yet; try again"

    def _take(self, message: SceneMessage) -> None:
        try:
            change = scene_change_of(self._model, message, _logger.debug)
        except PlanningError as error:
            _logger.warning("a change of the planning scene is not shown: %s", error)
            return
        outcome = change_scene(self._model, self.scene or PlanningScene({}), change, _logger.debug)
        for problem in outcome.problems:
            _logger.warning("a part of the planning scene is not shown: %s", problem)
        self.scene = outcome.scene


def _has_objects(message: SceneMessage) -> bool:
    """Return whether a difference is about objects; most are about the robot's joints alone."""
    state = message.robot_state
    return bool(
        message.world.collision_objects or state.attached_collision_objects or not state.is_diff
    )
