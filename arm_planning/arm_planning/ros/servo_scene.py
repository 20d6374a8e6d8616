"""The scene of servo_node: that of move_group, where one runs."""

import logging
from functools import partial
from typing import Any

from moveit_msgs.msg import PlanningScene as SceneMessage
from moveit_msgs.msg import PlanningSceneComponents
from moveit_msgs.srv import GetPlanningScene
from rclpy.node import Node

from arm_planning.errors import PlanningError
from arm_planning.robot.model import PlanningModel
from arm_planning.ros.convert_scene import scene_change_of
from arm_planning.scene.scene import PlanningScene
from arm_planning.scene.scene_changes import change_scene

DEPTH = 100
LOGGER = logging.getLogger("servo_node")


class ServoScene:
    """Follows the scene that move_group publishes. Executor's thread.

    Attributes:
        scene: the scene; the same object until something in it changes but the robot's state.
    """

    def __init__(self, node: Node, model: PlanningModel, scene: PlanningScene) -> None:
        self.scene = scene
        self._model = model
        self._is_asked = False
        self._client = node.create_client(GetPlanningScene, "get_planning_scene")
        node.create_subscription(SceneMessage, "monitored_planning_scene", self._take, DEPTH)

    def ask(self) -> None:
        """Ask move_group for its scene once it is there: it publishes changes only."""
        if self._is_asked or not self._client.service_is_ready():
            return
        self._is_asked = True
        request = GetPlanningScene.Request()
        request.components.components = sum(
            (
                PlanningSceneComponents.SCENE_SETTINGS,
                PlanningSceneComponents.ROBOT_STATE_ATTACHED_OBJECTS,
                PlanningSceneComponents.WORLD_OBJECT_GEOMETRY,
                PlanningSceneComponents.OCTOMAP,
                PlanningSceneComponents.TRANSFORMS,
                PlanningSceneComponents.ALLOWED_COLLISION_MATRIX,
                PlanningSceneComponents.LINK_PADDING_AND_SCALING,
            )
        )
        self._client.call_async(request).add_done_callback(partial(_give, self._take))

    def _take(self, message: SceneMessage) -> None:
        if message.is_diff and not _changes_more_than_the_state(message):
            return
        try:
            change = scene_change_of(self._model, message, LOGGER.warning)
            self.scene = change_scene(self._model, self.scene, change, LOGGER.warning).scene
        except PlanningError as error:
            LOGGER.error("the planning scene cannot be used: %s", error)


def _give(take: Any, future: Any) -> None:
    answer = future.result()
    if answer is not None:
        take(answer.scene)


def _changes_more_than_the_state(message: SceneMessage) -> bool:
    return bool(
        message.world.collision_objects
        or message.world.octomap.octomap.id
        or message.robot_state.attached_collision_objects
        or message.allowed_collision_matrix.entry_names
        or message.fixed_frame_transforms
        or message.link_padding
        or message.link_scale
    )
