"""Brings /joint_states into the core's readings."""

import logging

from rclpy.node import Node
from sensor_msgs.msg import JointState

from arm_controller.joint_readings import JointReadings
from arm_controller.ros.clock_time import seconds, steady_clock
from arm_controller.ros.polled_subscription import PolledSubscription
from arm_controller.silence_watch import PATIENCE_S, SilenceWatch

TOPIC = "joint_states"

logger = logging.getLogger(__name__)


class JointStateInput:
    """Updates readings with the messages that came, when asked to; tells when none come.

    Args:
        node: the node that subscribes.
        readings: what to update.
    """

    def __init__(self, node: Node, readings: JointReadings) -> None:
        self._readings = readings
        self._subscription = PolledSubscription(node, JointState, TOPIC)
        self._steady = steady_clock()
        self._silence = SilenceWatch(seconds(self._steady))

    def take(self) -> bool:
        """Take in what came since the last call; return whether it was anything of use."""
        messages = self._subscription.take()
        useful = [
            self._readings.update(
                list(message.name), message.position, message.velocity, message.effort
            )
            for message in messages
        ]
        now_s = seconds(self._steady)
        if messages:
            self._silence.hear(now_s)
        elif self._silence.notices(now_s):
            logger.warning(
                "/%s has been silent for %g s: is the joint_state_broadcaster active, "
                "the simulation paused?",
                TOPIC,
                PATIENCE_S,
            )
        return any(useful)
