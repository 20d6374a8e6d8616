"""Observe /clock and compare it with wall time."""

import time
from collections import deque
from dataclasses import replace

from rclpy.node import Node
from rclpy.serialization import deserialize_message
from rosgraph_msgs.msg import Clock

from arm_node.polled_subscriptions import PolledSubscriptions
from arm_node.qos import NEWEST
from arm_viewer.ros.observer import Observer, TopicTypes
from arm_viewer.snapshot import SimulationTime

TOPIC = "/clock"
PAUSED_AFTER_S = 0.5
"""After this time without a message the simulation counts as paused."""


class ClockObserver(Observer):
    """Keeps the progress of simulation time while /clock is published."""

    def __init__(self, node: Node, polled: PolledSubscriptions) -> None:
        """Subscribe."""
        self._node = node
        self._polled = polled
        self._subscription = polled.subscribe(Clock, TOPIC, NEWEST)
        self._comparison = ClockComparison()
        self._arrived_s = 0.0
        self.time: SimulationTime | None = None

    def discover(self, topics: TopicTypes) -> None:
        """Forget a clock that is no longer published."""
        if not self._node.count_publishers(TOPIC):
            self._comparison.clear()
            self.time = None

    def collect(self, now_s: float) -> None:
        """Take what has arrived."""
        for data, information in self._polled.take(self._subscription, 1):
            clock = deserialize_message(data, Clock).clock  # pyright: ignore[reportAttributeAccessIssue]
            # It arrived up to one collection period ago, which would be visible in the factor.
            before_s = self._arrived_s
            self._arrived_s = now_s - 1e-9 * (time.time_ns() - information["received_timestamp"])
            if self._arrived_s - before_s > PAUSED_AFTER_S:
                self._comparison.clear()  # A pause is not lag.
            self._comparison.add(self._arrived_s, clock.sec + 1e-9 * clock.nanosec)
            self.time = self._comparison.result()
        if self.time is not None and now_s - self._arrived_s > PAUSED_AFTER_S:
            self.time = replace(self.time, factor=0.0)


WINDOW_S = 10.0
FACTOR_WINDOW_S = 2.0
"""The factor uses a shorter window than the lag, so that a pause shows soon."""


class ClockComparison:
    """Recent readings of both clocks; use it from one thread at a time."""

    def __init__(self) -> None:
        self._readings: deque[tuple[float, float]] = deque()
        self._recent: deque[tuple[float, float]] = deque()

    def add(self, wall_s: float, time_s: float) -> None:
        """Add a reading, with a later wall time than all before.

        If simulation time goes back, the simulation was reset, and the comparison restarts.
        """
        if self._readings and time_s < self._readings[-1][1]:
            self.clear()
        for readings, window_s in ((self._readings, WINDOW_S), (self._recent, FACTOR_WINDOW_S)):
            readings.append((wall_s, time_s))
            while readings[0][0] < wall_s - window_s:
                readings.popleft()

    def clear(self) -> None:
        """Forget all readings."""
        self._readings.clear()
        self._recent.clear()

    def result(self) -> SimulationTime | None:
        """Return the real-time factor and lag, or None before the first reading."""
        if not self._readings:
            return None
        last_wall_s, last_s = self._readings[-1]
        first_wall_s, first_s = self._readings[0]
        recent_wall_s, recent_s = self._recent[0]
        passed_s = last_wall_s - recent_wall_s
        return SimulationTime(
            time_s=last_s,
            factor=(last_s - recent_s) / passed_s if passed_s > 0.0 else 0.0,
            lag_s=max(0.0, (last_wall_s - first_wall_s) - (last_s - first_s)),
            received_s=last_wall_s,
        )
