"""The robot of the topic robot_description in the points of a depth camera."""

import logging
from functools import partial

import numpy as np
from numpy.typing import NDArray
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.serialization import deserialize_message
from std_msgs.msg import Header, String

from arm_description.errors import DescriptionError
from arm_node.polled_subscriptions import PolledSubscriptions
from arm_planning.collision.seen_robot import SeenRobot
from arm_planning.errors import PlanningError
from arm_planning.ros.transform_reader import TransformReader

TOPIC = "robot_description"
LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
LOGGER = logging.getLogger("get_planning_scene_server")


class RobotInView:
    """Finds the robot where it was when a picture was taken. Executor's thread.

    Args:
        node: has the subscription.
        transforms: say where the links were.
        padding_m: by which each shape of a link is grown.
    """

    def __init__(self, node: Node, transforms: TransformReader, padding_m: float) -> None:
        self._transforms, self._padding_m = transforms, padding_m
        self._polled = PolledSubscriptions(node)
        self._description = self._polled.subscribe(String, TOPIC, LATCHED)
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
        """Return which points (height, width, 3) show the robot, (height, width); None if unknown.

        Args:
            header: frame and time of the points.
            points: in m.
        """
        if self._robot is None:
            return None
        pose_of = partial(self._transforms.pose, base=header.frame_id, stamp=header.stamp)
        return self._robot.pixels(points, pose_of)
