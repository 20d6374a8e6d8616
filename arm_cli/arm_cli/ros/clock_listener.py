"""Measures how far /clock advances."""

import time

from rosgraph_msgs.msg import Clock

from arm_cli.ros.qos import MEASURING
from arm_cli.ros.session import CommandSession


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
