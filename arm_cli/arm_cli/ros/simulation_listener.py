"""Listens to what a simulation says of itself: its time and its robot."""

import time

from rclpy.qos import DurabilityPolicy, QoSProfile
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from std_msgs.msg import String

from arm_cli.ros.qos import MEASURING
from arm_cli.ros.session import Session


class ClockListener:
    """Measures how far /clock goes.

    Attributes:
        now_s: the last time that came; 0 before.
    """

    def __init__(self, session: Session) -> None:
        """Subscribe with the session's node."""
        self.now_s = 0.0
        self._first: tuple[float, float] | None = None
        self._arrived_s = 0.0
        session.node.create_subscription(Clock, "/clock", self._take, MEASURING)

    @property
    def has_begun(self) -> bool:
        """Whether a message came."""
        return self._first is not None

    @property
    def simulated_s(self) -> float:
        """Between the first and the last message."""
        return self.now_s - self._first[0] if self._first else 0.0

    @property
    def wall_s(self) -> float:
        """Between their arrivals."""
        return self._arrived_s - self._first[1] if self._first else 0.0

    def _take(self, message: Clock) -> None:
        self.now_s = message.clock.sec + message.clock.nanosec * 1e-9
        self._arrived_s = time.monotonic()
        if self._first is None:
            self._first = (self.now_s, self._arrived_s)


class JointStateListener:
    """Counts the joint states of one topic.

    Attributes:
        topic: its absolute name.
        received: how many messages came.
    """

    def __init__(self, session: Session, topic: str) -> None:
        """Subscribe with the session's node."""
        self.topic = topic
        self.received = 0
        session.node.create_subscription(JointState, topic, self._take, MEASURING, raw=True)

    def _take(self, _message: bytes) -> None:
        self.received += 1


class DescriptionListener:
    """Waits for a robot description.

    Attributes:
        topic: its absolute name.
        text: the description, empty before it came.
    """

    def __init__(self, session: Session, topic: str) -> None:
        """Subscribe as those do who come later than the publisher."""
        self.topic = topic
        self.text = ""
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        session.node.create_subscription(String, topic, self._take, latched)

    def _take(self, message: String) -> None:
        self.text = message.data
