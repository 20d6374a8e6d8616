"""A robot that is no more than its topics, and the executables beside it in processes of their own.

Every wait is on a condition, with a generous timeout.
"""

import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
import rclpy
from programs import RosProgram
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rclpy.signals import SignalHandlerOptions
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray, String

from arm_node.workarounds.discovery import first_node

WAIT_TIMEOUT_S = 30.0
JOINTS = ("j0", "j1", "j2", "j3")
STATE_ORDER = ("j3", "j0", "j2", "j1")
"""Joint states come in any order; this one is no default."""
STATE_PERIOD_S = 0.02

LINKS = "".join(
    f"""
  <link name="l{index}"/>
  <joint name="j{index}" type="revolute">
    <parent link="base"/> <child link="l{index}"/>
    <limit lower="-2.57" upper="2.57" effort="5" velocity="{{velocity}}"/>
  </joint>"""
    for index in range(len(JOINTS))
)
URDF = f'<robot name="fake"><link name="base"/>{LINKS}</robot>'


def poll(condition: Callable[[], object], what: str, timeout_s: float = WAIT_TIMEOUT_S) -> object:
    """Return the condition's value as soon as it is true."""
    deadline = time.monotonic() + timeout_s
    pause = threading.Event()
    while True:
        value = condition()
        if value:
            return value
        if time.monotonic() > deadline:
            pytest.fail(f"not within {timeout_s} s: {what}")
        pause.wait(0.02)


class FakeRobot:
    """Position controller, joint states and description; its joints are where they are sent.

    Each part is made when a test asks for it: what a robot lacks is part of the tests.
    """

    def __init__(self) -> None:
        self.positions = dict.fromkeys(JOINTS, 0.0)
        self.stuck: set[str] = set()
        self.sent_ns: list[int] = []
        self._context = Context()
        rclpy.init(context=self._context, signal_handler_options=SignalHandlerOptions.NO)
        self._executor = SingleThreadedExecutor(context=self._context)
        self._nodes: list = []
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._spin)
        self._thread.start()

    def _spin(self) -> None:
        while not self._stop.is_set():
            self._executor.spin_once(timeout_sec=0.05)

    def node(self, name: str):
        """Add a node."""

        def make() -> Node:
            return Node(name, context=self._context)

        node = make() if self._nodes else first_node(make)
        self._nodes.append(node)
        self._executor.add_node(node)
        return node

    def listen(self, name: str = "position_controller", depth: int = 1) -> list[list[float]]:
        """Subscribe to the commands as a position controller does; return what will come.

        When the publisher sent each comes to `sent_ns`, of all subscriptions.
        """
        received: list[list[float]] = []

        def take(message: Float64MultiArray, info: dict) -> None:
            self.sent_ns.append(info["source_timestamp"])
            received.append(list(message.data))
            moving = {
                joint: position
                for joint, position in zip(JOINTS, message.data, strict=True)
                if joint not in self.stuck
            }
            self.positions.update(moving)

        qos = QoSProfile(depth=depth, reliability=ReliabilityPolicy.BEST_EFFORT)
        self.node(name).create_subscription(
            Float64MultiArray, "/position_controller/commands", take, qos
        )
        return received

    def describe(self, velocity: float = 2.0) -> None:
        """Publish a latched description with limits of 2.57 rad."""
        qos = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        publisher = self.node("robot_state_publisher").create_publisher(
            String, "/robot_description", qos
        )
        publisher.publish(String(data=URDF.format(velocity=velocity)))

    def broadcast(self) -> None:
        """Publish joint states, in an order of its own, efforts 10 times the positions."""
        node = self.node("joint_state_broadcaster")
        publisher = node.create_publisher(JointState, "/joint_states", 10)

        def publish() -> None:
            positions = [self.positions[name] for name in STATE_ORDER]
            publisher.publish(
                JointState(
                    name=list(STATE_ORDER),
                    position=positions,
                    velocity=[0.25] * len(positions),
                    effort=[10.0 * position for position in positions],
                )
            )

        node.create_timer(STATE_PERIOD_S, publish)

    def tick(self) -> None:
        """Publish /clock, ten times as fast as time passes."""
        node = self.node("clock")
        publisher = node.create_publisher(Clock, "/clock", 1)
        message = Clock()

        def publish() -> None:
            now_ns = message.clock.sec * 10**9 + message.clock.nanosec + 200_000_000
            message.clock.sec, message.clock.nanosec = divmod(now_ns, 10**9)
            publisher.publish(message)

        node.create_timer(0.02, publish)

    def sees(self, name: str) -> bool:
        """Whether a node of this name is in the graph."""
        return any(name in node.get_node_names() for node in self._nodes)

    def close(self) -> None:
        """End the executor, then the nodes, then the context."""
        self._stop.set()
        self._thread.join(10.0)
        self._executor.shutdown()
        for node in self._nodes:
            node.destroy_node()
        self._context.try_shutdown()


class TypedProgram(RosProgram):
    """A running executable that is typed to; its prompt, which has no line end, is seen."""

    def __init__(self, name: str, arguments: list[str], log_folder: Path) -> None:
        command = [sys.executable, Path(sys.executable).with_name(name), *arguments]
        environment = {**os.environ, "ROS_LOG_DIR": str(log_folder)}
        super().__init__(command, environment, subprocess.PIPE)

    def _read(self) -> None:
        output, chunk = b"", b"\n"
        while chunk:
            chunk = os.read(self.process.stdout.fileno(), 4096)
            output += chunk
            with self._changed:
                self._lines, self._is_closed = output.decode().splitlines(), not chunk
                self._changed.notify_all()

    def type(self, text: str) -> None:
        """Write to the standard input."""
        self.process.stdin.write(text)
        self.process.stdin.flush()

    def end_of_input(self) -> None:
        """Close the standard input."""
        self.process.stdin.close()


@pytest.fixture
def robot() -> Iterator[FakeRobot]:
    """A robot without any part yet."""
    made = FakeRobot()
    yield made
    made.close()


@pytest.fixture
def run(tmp_path: Path) -> Iterator[Callable[..., TypedProgram]]:
    """Start an executable of arm_controller by its name, with ROS parameters."""
    started: list[TypedProgram] = []

    def start(name: str, *arguments: str, **parameters: object) -> TypedProgram:
        options = [x for key, value in parameters.items() for x in ("-p", f"{key}:={value}")]
        program = TypedProgram(name, [*arguments, "--ros-args", *options], tmp_path / "log")
        started.append(program)
        return program

    yield start
    for program in started:
        # Killed, it might hold a lock in the shared memory of others, who would then hang.
        program.close(signal.SIGTERM)


@pytest.fixture
def until() -> Callable[..., object]:
    """Block until a condition is true: see `poll`."""
    return poll
