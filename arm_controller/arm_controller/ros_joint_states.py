"""The last known state of each joint, from /joint_states."""

import time
from collections.abc import Mapping, Sequence
from typing import Any

from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rclpy.serialization import deserialize_message
from sensor_msgs.msg import JointState

from arm_node.polled_subscriptions import PolledSubscriptions

DEPTH = 10
"""Enough for a message of each source of the topic."""
PATIENCE_S = 5.0


class JointReadings:
    """Keeps the latest state of each joint, and warns if the topic is silent.

    It takes new messages on request: at 500 Hz, a callback for each would take a sixth of a core.

    Attributes:
        positions: position (rad or m) by joint name, of all messages so far.
    """

    def __init__(self, node: Node) -> None:
        self.positions: dict[str, float] = {}
        self._velocities: dict[str, float] = {}
        self._efforts: dict[str, float] = {}
        self._logger = node.get_logger()
        self._polled = PolledSubscriptions(node)
        qos = QoSProfile(depth=DEPTH, reliability=ReliabilityPolicy.BEST_EFFORT)
        self._subscription = self._polled.subscribe(JointState, "joint_states", qos)
        self._heard_s = time.monotonic()
        self._is_silent = False

    def take(self) -> bool:
        """Process the messages since the last call; return whether any could be used."""
        messages: list[Any] = [
            deserialize_message(data, JointState)
            for data, _ in self._polled.take(self._subscription, DEPTH)
        ]
        now_s = time.monotonic()
        if messages:
            self._heard_s, self._is_silent = now_s, False
        elif now_s - self._heard_s >= PATIENCE_S and not self._is_silent:
            self._is_silent = True
            self._logger.warning(
                f"/joint_states has been silent for {PATIENCE_S:g} s: is the "
                "joint_state_broadcaster inactive, or the simulation paused?"
            )
        return any([self._update(message) for message in messages])

    def figures(self, name: str) -> Mapping[str, str]:
        """Return position, velocity and effort of a known joint as text, for a line of print."""
        return {
            "position": f"{self.positions[name]:.6f}",
            "velocity": _figure(self._velocities.get(name)),
            "effort": _figure(self._efforts.get(name)),
        }

    def _update(self, message: Any) -> bool:
        names: Sequence[str] = message.name
        if len(names) != len(message.position):
            return False
        self.positions.update(zip(names, message.position, strict=True))
        for known, values in (
            (self._velocities, message.velocity),
            (self._efforts, message.effort),
        ):
            for name in names:
                known.pop(name, None)
            if len(values) == len(names):  # Else they count as missing.
                known.update(zip(names, values, strict=True))
        return True


def _figure(value: float | None) -> str:
    return "unknown" if value is None else f"{value:.6f}"
