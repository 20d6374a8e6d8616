"""The service /get_planning_scene_mycobot: what a depth camera sees on a table as a scene."""

import logging
from collections.abc import Callable
from functools import partial
from math import inf
from typing import Any

import numpy as np
from moveit_msgs.msg import PlanningSceneWorld
from mycobot_interfaces.srv import GetPlanningScene
from numpy.typing import NDArray
from rclpy.node import Node
from rclpy.serialization import deserialize_message
from sensor_msgs.msg import Image, PointCloud2
from std_msgs.msg import Header, String

from arm_description.errors import DescriptionError
from arm_node.polled_subscriptions import PolledSubscriptions
from arm_node.qos import LATCHED, NEWEST
from arm_planning.collision.body_filter import PADDING_M, SeenRobot
from arm_planning.errors import PerceptionError, PlanningError
from arm_planning.perception.table_objects import Crop, TableTarget, objects_in_view
from arm_planning.ros.answering import offer_service
from arm_planning.ros.convert_scene import object_message
from arm_planning.ros.point_clouds import points_of
from arm_planning.ros.transform_reader import TransformReader

SERVICE = "get_planning_scene_mycobot"
POLL_S, SENSORS_S = 0.02, 5.0
"""How often and how long it waits for a camera that has only just been subscribed to."""
DESCRIPTION_TOPIC = "robot_description"
LOGGER = logging.getLogger("get_planning_scene_server")

Wait = Callable[[float], bool]
"""Waits for so many seconds; returns whether the process ends."""


class TableServer:
    """Answers with what the camera sees now. Executor's thread."""

    def __init__(self, node: Node, wait: Wait) -> None:
        """Read the parameters, subscribe to the camera, and offer the service.

        Raises:
            PerceptionError: a parameter has a value that cannot be used.
        """
        self._wait = wait
        self._polled = PolledSubscriptions(node)
        topics = {
            PointCloud2: _text(node, "point_cloud_topic", "/camera_head/depth/color/points"),
            Image: _text(node, "rgb_image_topic", "/camera_head/color/image_raw"),
        }
        self._topics = " and ".join(topics.values())
        self._cloud, self._image = (
            self._polled.subscribe(kind, topic, NEWEST) for kind, topic in topics.items()
        )
        self._latest: dict[type, Any] = {}
        self._frame = _text(node, "target_frame", "base_link")
        self._crop = _crop(node)
        self._support = _text(node, "support_surface_name", "support_surface")
        self._thickness_m = _number(node, "min_surface_thickness", 0.01)
        if not 0.0 < self._thickness_m < 1.0:
            raise PerceptionError(
                f"min_surface_thickness is {self._thickness_m} m; it is above 0 and below 1 m"
            )
        padding_m = _number(node, "robot_padding", PADDING_M)
        if not 0.0 <= padding_m < 1.0:
            raise PerceptionError(
                f"robot_padding is {padding_m} m; it is not negative and below 1 m"
            )
        self._transforms = TransformReader(node)
        self._robot = _RobotInView(node, self._transforms, padding_m)
        self._without_robot = False
        offer_service(node, GetPlanningScene, SERVICE, self._serve)

    def _serve(
        self, request: GetPlanningScene.Request, answer: GetPlanningScene.Response
    ) -> GetPlanningScene.Response:
        try:
            target = TableTarget(request.target_shape, tuple(request.target_dimensions))
            self._look(target, answer)
        except PerceptionError as error:
            # The answer has no place for a reason.
            LOGGER.error("%s", error)
            return answer
        answer.success = True
        return answer

    def _look(self, target: TableTarget, answer: GetPlanningScene.Response) -> None:
        """Fill the answer as far as possible."""
        cloud, image = self._sensed()
        answer.full_cloud, answer.rgb_image = cloud, image
        header = cloud.header
        camera = self._transforms.pose(header.frame_id, self._frame, header.stamp)
        if camera is None:
            raise PerceptionError(
                f"no transforms on /tf lead from '{header.frame_id}', the frame of the "
                f"points, to '{self._frame}'"
            )
        points = points_of(cloud)
        robot = self._robot.pixels(header, points)
        seen = objects_in_view(points, camera, self._crop, self._support, self._thickness_m, robot)
        objects = [object_message(each, self._frame) for each in seen.objects]
        answer.scene_world = PlanningSceneWorld(collision_objects=objects)
        answer.support_surface_id = self._support
        answer.target_object_id = seen.target(target)
        LOGGER.info("the target is %s", answer.target_object_id)

    def _sensed(self) -> tuple[PointCloud2, Image]:
        """Return the latest points and picture; wait for the first, and for the robot.

        Raises:
            PerceptionError: there are none.
        """
        waited_s = 0.0
        while True:
            for subscription in (self._cloud, self._image):
                for raw, _ in self._polled.take(subscription, 1):
                    kind = subscription.msg_type
                    self._latest[kind] = deserialize_message(raw, kind)
            is_late = waited_s >= SENSORS_S
            if not self._robot.is_heard() and is_late and not self._without_robot:
                LOGGER.warning("nobody publishes %s: the robot is not cut out", DESCRIPTION_TOPIC)
                self._without_robot = True
            if len(self._latest) == 2 and (self._without_robot or self._robot.is_heard()):
                return self._latest[PointCloud2], self._latest[Image]
            if is_late or self._wait(POLL_S):
                raise PerceptionError(
                    "Point cloud or RGB image data not available: nothing has come on "
                    f"{self._topics}; does the robot run with use_camera:=true?"
                )
            waited_s += POLL_S


def _crop(node: Node) -> Crop:
    """Return the space in the parameters; as upstream, the robot's own place is outside.

    Raises:
        PerceptionError: it is empty.
    """
    least, most = (
        (_number(node, f"{end}_x", x), _number(node, f"{end}_y", y), _number(node, f"{end}_z", z))
        for end, x, y, z in (("crop_min", 0.1, 0.0, -inf), ("crop_max", 1.1, 0.9, inf))
    )
    if not node.declare_parameter("enable_cropping", True).value:
        return Crop()
    for axis, low, high in zip("xyz", least, most, strict=True):
        if not low < high:
            raise PerceptionError(
                f"crop_min_{axis} is {low} and crop_max_{axis} is {high}: nothing is between them"
            )
    return Crop(least, most)


def _text(node: Node, name: str, value: str) -> str:
    return str(node.declare_parameter(name, value).value)


def _number(node: Node, name: str, value: float) -> float:
    given: Any = node.declare_parameter(name, value).value
    return float(given)


class _RobotInView:
    """Finds the robot of the topic robot_description where it was when a picture was taken.

    Each shape of a link is grown by `padding_m`.
    """

    def __init__(self, node: Node, transforms: TransformReader, padding_m: float) -> None:
        self._transforms, self._padding_m = transforms, padding_m
        self._polled = PolledSubscriptions(node)
        self._description = self._polled.subscribe(String, DESCRIPTION_TOPIC, LATCHED)
        self._robot: SeenRobot | None = None
        self._is_heard = False

    def is_heard(self) -> bool:
        """Return whether there has been a description; a new one is taken."""
        for raw, _ in self._polled.take(self._description, 1):
            self._is_heard = True
            message: String = deserialize_message(raw, String)
            try:
                self._robot = SeenRobot(message.data, self._padding_m)
            except (DescriptionError, PlanningError) as error:
                LOGGER.error("the robot is not cut out of what is seen: %s", error)
                self._robot = None
        return self._is_heard

    def pixels(self, header: Header, points: NDArray[np.float32]) -> NDArray[np.bool_] | None:
        """Return which points, (height, width, 3) in m, show the robot, (height, width).

        Return None if that is unknown. The header has frame and time of the points.
        """
        if self._robot is None:
            return None
        pose_of = partial(self._transforms.pose, base=header.frame_id, stamp=header.stamp)
        return self._robot.pixels(points, pose_of)
