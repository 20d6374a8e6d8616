"""The robot's present state, from /joint_states."""

import math
import threading
import time
from collections.abc import Callable

from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rclpy.serialization import deserialize_message
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState

from arm_node.names import listing
from arm_node.polled_subscriptions import PolledSubscriptions
from arm_node.qos import NEWEST
from arm_node.workarounds.clocks import CLOCK_TOPIC, USE_SIM_TIME, StampClock
from arm_planning.robot.model import PlanningModel
from arm_planning.ros.convert import NANOSECONDS, seconds

DEPTH = 20
"""Messages kept until they are read: several publishers may share the topic."""
FRESH_S = 0.05
"""A state that arrived so recently, or is so old in simulation time, is the present one."""
LATE_S = 0.25
"""After so long without a state, /clock is asked for the first time."""
POLL_S = 0.001
SILENCE_S = 0.25
"""A clock of which nothing is heard for this long stands still."""


class JointStateMonitor:
    """Merges the joint states of all publishers; any thread may ask for them.

    The topic is read when somebody asks, which costs nothing while nobody plans.
    """

    def __init__(self, node: Node, model: PlanningModel, *others: Node) -> None:
        """Subscribe to joint_states; `others`, too, take simulation time from their stamps."""
        self._model = model
        self._known = frozenset(model.joints)
        self._lock = threading.Lock()
        self._positions: dict[str, float] = {}
        self._velocities: dict[str, float] = {}
        self._stamp_s = 0.0
        self._arrived_s = -math.inf
        """On the system's clock, which is that of the middleware's time stamps."""
        self._clocks = [StampClock(each) for each in (node, *others)]
        self._polled = PolledSubscriptions(node)
        self._time = _HeldTime(node, self._polled)
        self._subscription = self._polled.subscribe(
            JointState,
            "joint_states",
            QoSProfile(depth=DEPTH, reliability=ReliabilityPolicy.BEST_EFFORT),
        )

    def positions(self) -> dict[str, float]:
        """Return the latest position of each active joint that has been heard, rad or m."""
        with self._lock:
            self._take()
            return dict(self._positions)

    def largest_speed(self) -> float:
        """Return the largest latest speed of a joint, rad/s or m/s; 0 where none is published."""
        with self._lock:
            self._take()
            return max(map(abs, self._velocities.values()), default=0.0)

    @property
    def stamp_s(self) -> float:
        """The stamp of the latest message in s: the robot's time."""
        with self._lock:
            self._take()
            return self._stamp_s

    def missing(self) -> tuple[str, ...]:
        """Return the active joints whose positions nobody has published yet."""
        known = self.positions()
        return tuple(joint for joint in self._model.joints if joint not in known)

    def wait_for_fresh(
        self, timeout_s: float, interrupted: Callable[[], bool] = lambda: False
    ) -> str:
        """Wait for a state from now, or 50 ms ago; return what is wrong after the timeout.

        While simulation time stands still, the last state is the present one.

        Returns:
            "", or a sentence: joint states have stopped, or joints are missing.
        """
        deadline_s = time.monotonic() + timeout_s
        # A busy machine may read late what arrived in time.
        oldest_s = time.time() - FRESH_S
        while True:
            missing = self.missing()
            age_s = time.time() - self._arrived_s
            if not missing and (self._arrived_s > oldest_s or self._is_held(age_s)):
                return ""
            if time.monotonic() >= deadline_s or interrupted():
                break
            time.sleep(POLL_S)
        if math.isinf(age_s):
            return "nobody publishes joint_states: start the robot and its joint_state_broadcaster"
        if missing:
            names = listing(missing)
            return f"The complete state of the robot is not yet known.  Missing {names}"
        return f"joint_states stopped {age_s:.1f} s ago; is joint_state_broadcaster active?"

    def _is_held(self, age_s: float) -> bool:
        """Whether somebody publishes states, and simulation time has not left the last one."""
        with self._lock:
            if not self._time.is_heard and age_s < LATE_S:
                return False
            if not self._subscription.get_publisher_count():
                return False
            return self._time.is_at(self._stamp_s, FRESH_S, time.monotonic())

    def _take(self) -> None:
        for raw, arrival in self._polled.take(self._subscription, DEPTH):
            message: JointState = deserialize_message(raw, JointState)
            # As upstream: a message whose lengths differ is dropped, unknown joints are skipped.
            if len(message.name) != len(message.position):
                continue
            self._arrived_s = arrival["received_timestamp"] * 1e-9
            self._stamp_s = seconds(message.header.stamp)
            for clock in self._clocks:
                clock.hear(tuple(message.name), round(self._stamp_s * NANOSECONDS))
            speeds = message.velocity if len(message.velocity) == len(message.name) else ()
            for index, (name, position) in enumerate(
                zip(message.name, message.position, strict=True)
            ):
                if name in self._known and math.isfinite(position):
                    self._positions[name] = position
                    if speeds:
                        self._velocities[name] = speeds[index]


class _HeldTime:
    """Tells whether simulation time stands still, paused or in lock-step. One thread at a time.

    A simulation publishes /clock in each control period, which costs it and its subscribers
    something, and not at all while time stands still. So the topic is subscribed to on the first
    question, and then for good: where time was held once, it will be again.
    """

    def __init__(self, node: Node, polled: PolledSubscriptions) -> None:
        """Do nothing yet; the node's parameter `use_sim_time` counts."""
        self._node = node
        self._polled = polled
        self._subscription = None
        self._time_s: float | None = None
        self._silent_since_s: float | None = None

    @property
    def is_heard(self) -> bool:
        """Whether the clock is known, so that a question costs nothing more."""
        return self._time_s is not None

    def is_at(self, stamp_s: float, within_s: float, now_s: float) -> bool:
        """Whether it is still about the time of a stamp; False where there is no simulation time.

        After a first silence it is at any stamp: time that stood still before the subscription was
        there is not known, and what was published last is the present.

        Args:
            stamp_s: the stamp.
            within_s: how far simulation time may be from it.
            now_s: wall time that never goes back.
        """
        if not self._node.get_parameter(USE_SIM_TIME).value:
            return False
        if self._subscription is None:
            self._subscription = self._polled.subscribe(Clock, CLOCK_TOPIC, NEWEST)
        if not self._subscription.get_publisher_count():
            self._time_s = self._silent_since_s = None
            return False
        for raw, _ in self._polled.take(self._subscription, 1):
            self._time_s = seconds(deserialize_message(raw, Clock).clock)
        if self._time_s is not None:
            return abs(self._time_s - stamp_s) < within_s
        if self._silent_since_s is None:
            self._silent_since_s = now_s
        return now_s - self._silent_since_s >= SILENCE_S
