"""Subscriptions that are polled instead of served by an executor.

For every message, rclpy's executor rebuilds a wait set of all subscriptions, which for the topics
of a robot costs 20 times as much as taking the message. A reader that need not react at once can
poll instead; the middleware records when each message arrived.
"""

from collections.abc import Iterator
from typing import Any

from rclpy.callback_groups import CallbackGroup
from rclpy.event_handler import SubscriptionEventCallbacks
from rclpy.node import Node
from rclpy.qos import QoSProfile
from rclpy.subscription import Subscription


class Unserved(CallbackGroup):
    """The group of subscriptions and events that the executor must not serve."""

    def can_execute(self, entity: Any) -> bool:
        """Return False."""
        return False

    def beginning_execution(self, entity: Any) -> bool:
        """Return False, for an entity that was ready when it came into the group."""
        return False

    def ending_execution(self, entity: Any) -> None:
        """Do nothing."""


class PolledSubscriptions(Unserved):
    """Creates subscriptions of a node that its executor does not serve.

    They have no QoS events: Fast DDS wakes a thread that waits for events while messages are
    pending, so the executor would never sleep.
    """

    def __init__(self, node: Node) -> None:
        """Use this node for the subscriptions."""
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
        """Yield up to `limit` pending messages, each with its metadata."""
        handle, message_class = subscription.handle, subscription.msg_type
        with handle:
            for _ in range(limit):
                taken = handle.take_message(message_class, True)
                if taken is None:
                    return
                yield taken


def _not_called(_: bytes) -> None:
    """Do nothing; rclpy requires a callback."""
