"""Reads /joint_states into the core's readings."""

import logging
import time
from typing import Any

from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rclpy.serialization import deserialize_message
from sensor_msgs.msg import JointState

from arm_controller.joint_states import PATIENCE_S, JointReadings, SilenceWatch
from arm_node.polled_subscriptions import PolledSubscriptions

TOPIC = "joint_states"
DEPTH = 10
"""Enough for a message of each source of the topic."""
QOS = QoSProfile(depth=DEPTH, reliability=ReliabilityPolicy.BEST_EFFORT)

logger = logging.getLogger(__name__)


class JointStateInput:
    """Updates readings with new messages on request, and warns if there are none.

    At 500 Hz, a callback for each message would take a sixth of a core.

    Args:
        node: the node that subscribes.
        readings: the readings to update.
    """

    def __init__(self, node: Node, readings: JointReadings) -> None:
        self._readings = readings
        self._polled = PolledSubscriptions(node)
        self._subscription = self._polled.subscribe(JointState, TOPIC, QOS)
        self._silence = SilenceWatch(time.monotonic())

    def take(self) -> bool:
        """Process the messages since the last call; return whether any could be used."""
        taken = self._polled.take(self._subscription, DEPTH)
        messages: list[Any] = [deserialize_message(data, JointState) for data, _ in taken]
        useful = [
            self._readings.update(
                list(message.name), message.position, message.velocity, message.effort
            )
            for message in messages
        ]
        now_s = time.monotonic()
        if messages:
            self._silence.hear(now_s)
        elif self._silence.notices(now_s):
            logger.warning(
                "/%s has been silent for %g s: is the joint_state_broadcaster inactive, "
                "or the simulation paused?",
                TOPIC,
                PATIENCE_S,
            )
        return any(useful)
