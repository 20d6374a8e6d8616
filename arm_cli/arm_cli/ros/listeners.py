"""Subscribes to a topic with the type and the QoS found on the graph, and to /clock."""

import os
import time
from collections.abc import Callable
from typing import Any

from rclpy.qos import QoSProfile
from rclpy.subscription import Subscription
from rosgraph_msgs.msg import Clock

from arm_cli.errors import NoSuchNameError
from arm_cli.interface_types import InterfaceIndex, load_class
from arm_cli.names import is_hidden, this_domain
from arm_cli.ros.graph import Graph
from arm_cli.ros.qos import MEASURING, matching_profile
from arm_cli.ros.session import CommandSession
from arm_node.names import describe_known
from arm_node.ros_domain import describe_users, other_users
from arm_node.workarounds.ports import lost_ports
from launch_py.fast_dds.participants import domain_of


class TopicListener:
    """Listens to one topic."""

    def __init__(self, session: CommandSession, topic: str) -> None:
        """Prepare to listen with a session's node.

        Raises:
            NameValidationException: the name is not a valid topic name.
        """
        self.topic = session.full_name(topic)
        self._session = session
        self._graph = Graph(session)
        self._subscribed = ""

    def find_class(self) -> type:
        """Return the message class of the topic as soon as it is discovered.

        Raises:
            NoSuchNameError: there is no such topic, or its type is not installed.
        """
        return self._class_of(self._graph.find_topic(self.topic))

    def wait_for_class(self) -> type:
        """Return the message class of the topic once it has a publisher or a subscription.

        Raises:
            NoSuchNameError: its type is not installed.
        """
        types: list[str] = []

        def found() -> bool:
            types[:] = self._graph.topics(hidden=True).get(self.topic, [])
            return bool(types)

        self._session.wait_until(found, self._missing_topic)
        return self._class_of(types)

    def matching_profile(self) -> QoSProfile:
        """Return a QoS profile that matches the topic's present publishers."""
        return matching_profile(self._graph.find_publishers(self.topic))

    def subscribe(
        self,
        message_class: type,
        callback: Callable[..., None],
        profile: QoSProfile = MEASURING,
        raw: bool = False,
    ) -> Subscription:
        """Subscribe; the callback gets the messages, as bytes if `raw`."""
        node = self._session.node
        self._subscribed = f"{message_class.__module__.split('.')[0]}/msg/{message_class.__name__}"
        return node.create_subscription(message_class, self.topic, callback, profile, raw=raw)

    def silence(self) -> str:
        """Return a notice that says why no message has arrived yet."""
        types = sorted({publisher.topic_type for publisher in self._graph.publishers(self.topic)})
        if types and self._subscribed and self._subscribed not in types:
            return (
                f"waiting for a {self._subscribed} on {self.topic}; "
                f"its publishers send {', '.join(types)}"
            )
        if lost := lost_ports():
            ports = " and ".join(lost)
            return f"this command hears nothing, because another process removed {ports}; repeat it"
        if types:
            users = other_users(domain_of(os.environ.get("ROS_DOMAIN_ID")) or 0)
            hint = f"; {describe_users(users)}" if users else ""
            return f"waiting for a message on {self.topic}{hint}"
        return f"waiting for a publisher of {self.topic}"

    def _missing_topic(self) -> str:
        known = [name for name in self._graph.topics() if not is_hidden(name)]
        near = describe_known(self.topic, known)
        hint = f"; {near}" if near.startswith("did") else ""
        return f"waiting for topic {self.topic} on {this_domain()}{hint}"

    def _class_of(self, types: list[str]) -> Any:
        if len(types) > 1:
            raise NoSuchNameError(
                f"{self.topic} has messages of several types: {', '.join(types)}; name one of them"
            )
        return load_class(InterfaceIndex().find(types[0], ("msg",)))


class ClockListener:
    """Measures how far /clock advances.

    Attributes:
        now_s: the last time received, 0 before the first.
    """

    def __init__(self, session: CommandSession) -> None:
        """Subscribe with the session's node."""
        self.now_s = 0.0
        self._first: tuple[float, float] | None = None
        self._arrived_s = 0.0
        session.node.create_subscription(Clock, "/clock", self._take, MEASURING)

    @property
    def has_begun(self) -> bool:
        """Whether a message has arrived."""
        return self._first is not None

    @property
    def simulated_s(self) -> float:
        """The simulation time between the first and the last message."""
        return self.now_s - self._first[0] if self._first else 0.0

    @property
    def wall_s(self) -> float:
        """The wall time between their arrivals."""
        return self._arrived_s - self._first[1] if self._first else 0.0

    def _take(self, message: Clock) -> None:
        self.now_s = message.clock.sec + message.clock.nanosec * 1e-9
        self._arrived_s = time.monotonic()
        if self._first is None:
            self._first = (self.now_s, self._arrived_s)
