"""When the joint states that were heard last are the robot's present state."""

from collections import deque
from types import SimpleNamespace
from typing import Any

import pytest
from builtin_interfaces.msg import Time
from planar_robot import planar_model
from rclpy.serialization import serialize_message
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState

from arm_planning.ros import joint_state_monitor
from arm_planning.ros.joint_state_monitor import JointStateMonitor

TIMEOUT_S = 1.0


class Topic:
    """A subscription whose messages arrive when the test says so."""

    raw = True

    def __init__(self, msg_type: type) -> None:
        self.msg_type = msg_type
        self.publishers = 1
        self.messages: deque[tuple[bytes, dict[str, Any]]] = deque()
        self.handle = self

    def __enter__(self) -> "Topic":
        return self

    def __exit__(self, *_: object) -> None:
        pass

    def take_message(self, _type: type, _raw: bool) -> tuple[bytes, dict[str, Any]] | None:
        return self.messages.popleft() if self.messages else None

    def get_publisher_count(self) -> int:
        return self.publishers


class Robot:
    """A node with the robot's topics, and the wall time in which it is asked.

    Attributes:
        ticks: whether the simulation runs; it publishes its clock, and joint states while
            `states` is true.
    """

    subscriptions = ()

    def __init__(self) -> None:
        self.wall_s = 1000.0
        self.time_s = 5.0
        self.ticks = self.states = self.uses_sim_time = True
        self.topics: dict[str, Topic] = {}

    # A node

    def create_subscription(self, msg_type: type, topic: str, *_: object, **__: object) -> Topic:
        self.topics[topic] = Topic(msg_type)
        return self.topics[topic]

    def get_clock(self) -> None:
        return None

    def get_parameter(self, _name: str) -> SimpleNamespace:
        return SimpleNamespace(value=self.uses_sim_time)

    # The module time

    def time(self) -> float:
        return self.wall_s

    monotonic = time

    def sleep(self, duration_s: float) -> None:
        self.wall_s += duration_s
        if self.ticks:
            self.tick(duration_s)

    def tick(self, duration_s: float) -> None:
        """Let simulation time go on, as in a step of lock-step."""
        self.time_s += duration_s
        stamp = Time(sec=int(self.time_s), nanosec=int(self.time_s % 1.0 * 1e9))
        if "/clock" in self.topics:
            self.topics["/clock"].messages.clear()  # It keeps the newest.
            self._send("/clock", Clock(clock=stamp))
        if self.states:
            state = JointState(name=["shoulder", "elbow"], position=[0.1, 0.2])
            state.header.stamp = stamp
            self._send("joint_states", state)

    def _send(self, topic: str, message: Any) -> None:
        info = {"received_timestamp": round(self.wall_s * 1e9)}
        self.topics[topic].messages.append((serialize_message(message), info))


@pytest.fixture
def robot(monkeypatch) -> Robot:
    made = Robot()
    monkeypatch.setattr(joint_state_monitor, "time", made)
    return made


@pytest.fixture
def monitor(robot) -> JointStateMonitor:
    """One that has heard a state."""
    node: Any = robot
    made = JointStateMonitor(node, planar_model())
    robot.tick(0.0)
    assert made.wait_for_fresh(TIMEOUT_S) == ""
    return made


def test_while_time_stands_still_the_last_state_is_the_present_one(robot, monitor):
    robot.ticks = False
    robot.wall_s += 10.0
    assert monitor.wait_for_fresh(TIMEOUT_S) == ""
    assert monitor.positions() == {"shoulder": 0.1, "elbow": 0.2}
    # In lock-step, the clock of later periods is heard: nobody waits any more.
    robot.tick(0.01)
    robot.wall_s += 10.0
    before_s = robot.wall_s
    assert monitor.wait_for_fresh(TIMEOUT_S) == ""
    assert robot.wall_s == before_s


def test_states_that_stop_while_time_goes_on_are_old(robot, monitor):
    robot.states = False
    robot.sleep(0.1)
    assert "joint_states stopped 1.1 s ago" in monitor.wait_for_fresh(TIMEOUT_S)
    robot.ticks = False
    assert "joint_states stopped 2.1 s ago" in monitor.wait_for_fresh(TIMEOUT_S)


@pytest.mark.parametrize("gone", ["joint_states", "/clock"])
def test_without_its_publisher_a_state_is_old(robot, monitor, gone):
    robot.ticks = False
    robot.wall_s += 10.0
    assert monitor.wait_for_fresh(TIMEOUT_S) == ""
    robot.topics[gone].publishers = 0
    assert "joint_states stopped" in monitor.wait_for_fresh(TIMEOUT_S)


def test_a_state_that_a_busy_machine_reads_late_is_fresh(robot, monitor, monkeypatch):
    def sleep(duration_s: float) -> None:
        robot.tick(duration_s)
        robot.wall_s += 0.2

    monkeypatch.setattr(robot, "sleep", sleep)
    robot.uses_sim_time = False
    robot.wall_s += 10.0
    assert monitor.wait_for_fresh(TIMEOUT_S) == ""


def test_without_simulation_time_a_state_gets_old(robot, monitor):
    robot.ticks = robot.uses_sim_time = False
    robot.wall_s += 10.0
    assert "joint_states stopped" in monitor.wait_for_fresh(TIMEOUT_S)
    assert list(robot.topics) == ["joint_states"]
