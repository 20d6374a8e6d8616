"""Subscriptions whose messages are fetched, instead of delivered by an executor.

For every message rclpy's executor builds a wait set of all subscriptions anew, which for the topics
of a robot costs 20 times what taking the message does. Whoever need not react at once looks now and
then: the middleware has noted when each message came.
"""

from collections.abc import Iterator
from typing import Any

from rclpy.callback_groups import CallbackGroup
from rclpy.event_handler import SubscriptionEventCallbacks
from rclpy.node import Node
from rclpy.qos import QoSProfile
from rclpy.subscription import Subscription


class PolledSubscriptions(CallbackGroup):
    """Makes subscriptions of a node that its executor leaves alone.

    They have no QoS events: Fast DDS wakes whoever waits for one while there is a message to be
    fetched, so the executor would never sleep.
    """

    def __init__(self, node: Node) -> None:
        """Make them on this node."""
        super().__init__()
        self._node = node

    def subscribe(self, message_class: type, topic: str, profile: QoSProfile) -> Any:
        """Return a subscription to a topic's messages as bytes."""
        return self._node.create_subscription(
            message_class,
            topic,
            _not_called,
            profile,
            callback_group=self,
            event_callbacks=SubscriptionEventCallbacks(use_default_callbacks=False),
            raw=True,
        )

    @staticmethod
    def take(subscription: Subscription, limit: int) -> Iterator[tuple[bytes, dict[str, Any]]]:
        """Yield the messages that have come, at most some, each with what is known of its way."""
        handle, message_class = subscription.handle, subscription.msg_type
        with handle:
            for _ in range(limit):
                taken = handle.take_message(message_class, True)
                if taken is None:
                    return
                yield taken

    def can_execute(self, entity: Any) -> bool:
        """Return whether the executor may serve it."""
        return False

    def beginning_execution(self, entity: Any) -> bool:
        """Allow it."""
        return True

    def ending_execution(self, entity: Any) -> None:
        """Take notice of an end."""


def _not_called(_: bytes) -> None:
    """Satisfy rclpy, which wants a callback."""
