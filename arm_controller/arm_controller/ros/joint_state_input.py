"""Brings /joint_states into the core's readings."""

from rclpy.node import Node
from sensor_msgs.msg import JointState

from arm_controller.joint_readings import JointReadings
from arm_controller.ros.polled_subscription import PolledSubscription

TOPIC = "joint_states"


class JointStateInput:
    """Updates readings with the messages that came, when asked to.

    Args:
        node: the node that subscribes.
        readings: what to update.
    """

    def __init__(self, node: Node, readings: JointReadings) -> None:
        self._readings = readings
        self._subscription = PolledSubscription(node, JointState, TOPIC)

    def take(self) -> bool:
        """Take in what came since the last call; return whether it was anything of use."""
        useful = [
            self._readings.update(
                list(message.name), message.position, message.velocity, message.effort
            )
            for message in self._subscription.take()
        ]
        return any(useful)
