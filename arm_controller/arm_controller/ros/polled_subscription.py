"""A subscription that is asked for its messages instead of being called for each.

Joint states come up to 1000 times a second; who wants them once a second should not pay for every
one of them: at 500 Hz the callbacks alone take a sixth of a core.
"""

from typing import Generic, TypeVar

from rclpy.callback_groups import CallbackGroup
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy

Message = TypeVar("Message")

DEPTH = 10
"""Enough for a message of each source of the topic."""


class PolledSubscription(Generic[Message]):
    """Keeps the last messages of a topic in the middleware until `take`; best effort."""

    def __init__(self, node: Node, message_type: type[Message], topic: str) -> None:
        qos = QoSProfile(depth=DEPTH, reliability=ReliabilityPolicy.BEST_EFFORT)
        self._subscription = node.create_subscription(
            message_type, topic, _never_called, qos, callback_group=_NeverReady()
        )

    def take(self) -> list[Message]:
        """Return the messages since the last call, at most ten, the oldest first."""
        messages: list[Message] = []
        handle = self._subscription.handle
        with handle:
            while (taken := handle.take_message(self._subscription.msg_type, False)) is not None:
                messages.append(taken[0])
        return messages


def _never_called(_message: object) -> None:
    raise AssertionError("the executor ran a subscription that it must leave alone")


class _NeverReady(CallbackGroup):
    """Keeps its members out of what the executor waits for."""

    def can_execute(self, entity: object) -> bool:
        return False

    def beginning_execution(self, entity: object) -> bool:
        return False

    def ending_execution(self, entity: object) -> None:
        return
