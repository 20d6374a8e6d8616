"""One topic of commands, and who listens to it."""

from typing import Any

from rclpy.node import Node

from arm_controller.listener_watch import Audience, ListenerWatch
from arm_controller.ros.clock_time import seconds, steady_clock

DEPTH = 10


class CommandTopic:
    """A publisher that knows its audience; for one thread.

    Args:
        node: the node that publishes.
        message_type: class of the messages.
        name: of the topic.
    """

    def __init__(self, node: Node, message_type: type[Any], name: str) -> None:
        self._node = node
        self._steady = steady_clock()
        self._publisher = node.create_publisher(message_type, name, DEPTH)
        # A controller subscribes below its own name, so its node is called as the topic's parent.
        self._watch = ListenerWatch(self.name.rpartition("/")[0], self._now_s())

    @property
    def name(self) -> str:
        """The topic's full name, remapping included."""
        return self._publisher.topic_name

    @property
    def is_ready(self) -> bool:
        """Whether a command that is published now reaches its addressee."""
        return self._watch.is_ready(self._now_s())

    @property
    def lasting_s(self) -> float:
        """For how long those who listen (or nobody) have done so."""
        return self._watch.lasting_s(self._now_s())

    @property
    def audience(self) -> Audience:
        """Who listened at the last `observe`."""
        return self._watch.audience

    def describe_audience(self) -> str:
        """Return a few words on who listens."""
        return f"{self._watch.describe()} on {self.name}"

    def observe(self) -> None:
        """Look who listens now."""
        listeners: list[str] = []
        # The graph may know of an endpoint before (or without) a match with this publisher.
        if self._publisher.get_subscription_count() > 0:
            listeners = [
                f"{info.node_namespace.rstrip('/')}/{info.node_name}"
                for info in self._node.get_subscriptions_info_by_topic(self.name)
            ]
        self._watch.observe(listeners, self._now_s())

    def publish(self, message: object) -> None:
        """Publish one command."""
        self._publisher.publish(message)

    def _now_s(self) -> float:
        return seconds(self._steady)
