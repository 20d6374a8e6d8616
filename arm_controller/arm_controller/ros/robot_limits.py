"""The joint limits that /robot_description tells."""

import logging
from collections.abc import Sequence

from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import String

from arm_controller.errors import ArmControllerError
from arm_controller.joint_limits import limits_of, no_limits
from arm_description.errors import DescriptionError
from arm_description.urdf import parse_urdf

TOPIC = "robot_description"

logger = logging.getLogger(__name__)


class RobotLimits:
    """Subscribes to the latched description; `limits` allow everything until it comes."""

    def __init__(self, node: Node, joint_names: Sequence[str]) -> None:
        self._joint_names = tuple(joint_names)
        self.limits = no_limits(joint_names)
        self.known = False
        qos = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self._subscription = node.create_subscription(String, TOPIC, self._take, qos)

    def _take(self, message: String) -> None:
        try:
            self.limits = limits_of(parse_urdf(message.data, TOPIC), self._joint_names)
        except (DescriptionError, ArmControllerError) as error:
            logger.error("/%s gives no joint limits: %s", TOPIC, error)
            return
        self.known = True
