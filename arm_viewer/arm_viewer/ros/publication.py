"""Publish a message once, or at a rate until somebody stops it."""

import time
from typing import Any

from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile

from arm_node.messages.filling import FilledMessage
from arm_node.testing import DiscoveryCheck
from arm_viewer.calls.call import CallState, failure
from arm_viewer.ros.service_call import Report

MATCH_S = 2.0
"""How long a single message waits for subscribers."""
KNOWN_S = 5.0
"""How long it waits until they know the publisher."""
LINGER_S = 1.0
"""How long the publisher lives on after its only message, so that it arrives."""
SHOW_S = 0.5


class Publication:
    """Publishes one message, or the same one again and again."""

    def __init__(
        self,
        node: Node,
        message_class: Any,
        topic: str,
        filled: FilledMessage,
        rate_hz: float,
        report: Report,
    ) -> None:
        """Make the publisher; a rate of 0 publishes once."""
        self._node = node
        self._filled = filled
        self._rate_hz = rate_hz
        self._report = report
        readers = node.get_subscriptions_info_by_topic(topic)
        keeps = any(r.qos_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL for r in readers)
        durability = DurabilityPolicy.TRANSIENT_LOCAL if keeps else DurabilityPolicy.VOLATILE
        self._publisher = node.create_publisher(
            message_class, topic, QoSProfile(depth=10, durability=durability)
        )
        self._known = DiscoveryCheck(node, topic)
        self._start_s = time.monotonic()
        self._sent_s = self._shown_s = 0.0
        self._count = 0
        self._timer = node.create_timer(1.0 / rate_hz, self._publish) if rate_hz else None
        report(CallState("Looking for subscribers"))

    def check(self, now_s: float) -> None:
        """Publish the only message when there is a subscriber; report the count of many."""
        if self._rate_hz:
            if now_s - self._shown_s >= SHOW_S:
                self._shown_s = now_s
                self._report(CallState(self._told()))
        elif not self._count:
            if self._is_known(now_s):
                self._publish()
                self._sent_s = now_s
        elif now_s - self._sent_s > LINGER_S:
            self._report(CallState(self._told(), is_over=True))

    def cancel(self) -> None:
        """Stop publishing."""
        self._report(CallState(self._told(), is_over=True) if self._count else failure("Stopped"))

    def close(self) -> None:
        """Destroy the publisher."""
        self._known.close()
        if self._timer is not None:
            self._node.destroy_timer(self._timer)
        self._node.destroy_publisher(self._publisher)

    def _is_known(self, now_s: float) -> bool:
        """Return whether the subscribers know the publisher; earlier messages are lost."""
        longest_s = KNOWN_S if self._publisher.get_subscription_count() else MATCH_S
        return self._known.complete or now_s - self._start_s > longest_s

    def _publish(self) -> None:
        self._filled.stamp(self._node.get_clock().now().to_msg())
        self._publisher.publish(self._filled.message)
        self._count += 1

    def _told(self) -> str:
        readers = self._publisher.get_subscription_count()
        times = "once" if self._count == 1 else f"{self._count} times"
        whom = "nobody subscribes" if not readers else "to 1 subscription"
        return f"Published {times}, {whom if readers < 2 else f'to {readers} subscriptions'}"
