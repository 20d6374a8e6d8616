"""The topic robot_description, from which a controller manager gets its robot's URDF."""

import logging

from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from std_msgs.msg import String

logger = logging.getLogger("controller_manager")

LATCHED_QOS = QoSProfile(
    depth=1,
    reliability=ReliabilityPolicy.RELIABLE,
    durability=DurabilityPolicy.TRANSIENT_LOCAL,
)


class DescriptionTopic:
    """Keeps the latest description until one is in use; then it ignores others with a warning.

    Until `use` is called, it belongs to the thread that spins the node.
    """

    def __init__(self, node: Node, in_use: str = "") -> None:
        """Subscribe.

        Args:
            node: the controller manager's node.
            in_use: the description already in use; empty if there is none.
        """
        self._in_use = in_use
        self._latest: str | None = None
        self._subscription = node.create_subscription(
            String, "robot_description", self._take, LATCHED_QOS
        )

    @property
    def name(self) -> str:
        """Full name of the topic."""
        return self._subscription.topic_name

    def take(self) -> str | None:
        """Return the latest description once; None if there is no new one."""
        latest, self._latest = self._latest, None
        return latest

    def use(self, description: str) -> None:
        """Ignore every other description from now on."""
        self._in_use = description

    def _take(self, message: String) -> None:
        if not self._in_use:
            self._latest = message.data
        elif message.data != self._in_use:
            logger.warning(
                "a robot description other than the one in use was published on %s. "
                "Ignoring attempt to reload a robot description.",
                self.name,
            )
