"""A black-box view of the suite: the real launcher in processes of its own, and a client beside it.

Nothing here sleeps: every wait is on a condition, with a generous timeout.
"""

import os
import sys
import threading
import time
from array import array
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
import rclpy
import yaml
from programs import Program
from rcl_interfaces.srv import GetParameters
from rcl_interfaces.srv import SetParametersAtomically as Service
from rclpy.action import ActionClient
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter, parameter_value_to_python
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.signals import SignalHandlerOptions

from arm_node.testing import DiscoveryCheck
from arm_node.workarounds.discovery import first_node

WAIT_TIMEOUT_S = 60.0
QUEUE_DEPTH = 1000
"""Of a subscription: with ROS's usual 10, a test that a busy machine holds up for a tenth of a
second would lose messages of a 100 Hz topic."""


def pytest_itemcollected(item: pytest.Item) -> None:
    """Mark every test of this folder."""
    item.add_marker("ros")


@pytest.fixture
def launch(tmp_path: Path) -> Iterator[Callable[..., Program]]:
    """Start `arm launch ARGUMENTS`, which ends with the test at the latest."""
    yield from _launcher(tmp_path)


@pytest.fixture(scope="module")
def launch_for_file(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Callable[..., Program]]:
    """Start `arm launch ARGUMENTS`, which ends with the last test of the file at the latest."""
    yield from _launcher(tmp_path_factory.mktemp("launch"))


@pytest.fixture(scope="class")
def launch_for_class(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Callable[..., Program]]:
    """Start `arm launch ARGUMENTS`, which ends with the last test of the class at the latest."""
    yield from _launcher(tmp_path_factory.mktemp("launch"))


def _launcher(folder: Path) -> Iterator[Callable[..., Program]]:
    started: list[Program] = []

    def start(*arguments: str, **environment: str) -> Program:
        command = [sys.executable, "-m", "arm_cli", "launch", *arguments]
        own = {**os.environ, "ROS_LOG_DIR": str(folder / "log"), **environment}
        started.append(Program(command, own))
        return started[-1]

    yield start
    for launched in started:
        launched.close()


@pytest.fixture(scope="module")
def simulate(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Callable[[dict], Program]]:
    """Run the simulation alone with these parameters by node; it ends with the file's last test."""
    started: list[Program] = []

    def start(parameters: dict[str, dict]) -> Program:
        path = tmp_path_factory.mktemp("simulation") / "parameters.yaml"
        nodes = {node: {"ros__parameters": values} for node, values in parameters.items()}
        path.write_text(yaml.safe_dump(nodes))
        command = [sys.executable, "-m", "arm_gazebo.arm_gazebo_node"]
        started.append(Program([*command, "--ros-args", "--params-file", path]))
        return started[-1]

    yield start
    try:
        assert [program.stop() for program in started] == [0] * len(started)
    finally:
        for program in started:
            program.close()


class Collector:
    """The messages of one topic as they arrive."""

    def __init__(self) -> None:
        self.messages: list = []
        self.arrivals_s: list[float] = []
        self.changed = threading.Condition()
        self._cleared_ns = 0

    def take(self, message: object, information: dict[str, int]) -> None:
        """Keep a message, unless it had arrived before the last `clear`.

        On a busy machine the executor may take a message long after it has arrived.
        """
        if information["received_timestamp"] >= self._cleared_ns:
            self(message)

    def __call__(self, message: object) -> None:
        with self.changed:
            self.messages.append(message)
            self.arrivals_s.append(time.monotonic())
            self.changed.notify_all()

    def clear(self) -> None:
        """Discard the messages so far, and those that have arrived but are not taken yet."""
        with self.changed:
            self._cleared_ns = time.time_ns()
            self.messages.clear()
            self.arrivals_s.clear()

    def wait_until(
        self, condition: Callable[[list], bool], what: str, timeout_s: float = WAIT_TIMEOUT_S
    ) -> list:
        """Block until the condition holds for the messages so far; return a copy of them."""
        deadline = time.monotonic() + timeout_s
        with self.changed:
            while not condition(self.messages):
                left = deadline - time.monotonic()
                if left <= 0:
                    last = self.messages[-1] if self.messages else None
                    pytest.fail(
                        f"not within {timeout_s} s: {what}; "
                        f"{len(self.messages)} messages, last {last}"
                    )
                self.changed.wait(left)
            return list(self.messages)

    def wait_for(self, count: int = 1, timeout_s: float = WAIT_TIMEOUT_S) -> list:
        """Block until `count` messages have arrived."""
        return self.wait_until(lambda m: len(m) >= count, f"{count} messages", timeout_s)


class Client:
    """An ordinary user's rclpy node: default settings, and an executor in a thread.

    It is made as `arm run` makes a program's first node: beside a busy simulation one in some
    hundred would else hear nothing.

    Args:
        domain: ROS domain; by default that of the tests.
    """

    def __init__(self, domain: int | None = None) -> None:
        self.context = Context()
        rclpy.init(
            context=self.context, signal_handler_options=SignalHandlerOptions.NO, domain_id=domain
        )
        self.node = first_node(lambda: Node("test_client", context=self.context))
        self.executor = SingleThreadedExecutor(context=self.context)
        self._actions: list[Any] = []
        self._callers: dict[tuple[type, str], Any] = {}
        self._known: dict[Any, set[object]] = {}
        self.executor.add_node(self.node)
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._spin, daemon=True)
        self._thread.start()

    def _spin(self) -> None:
        while not self._stop.is_set():
            self.executor.spin_once(timeout_sec=0.05)

    def subscribe(self, message_type: type, topic: str, qos: object = QUEUE_DEPTH) -> Collector:
        """Collect a topic's messages from now on."""
        collector = Collector()
        self.node.create_subscription(message_type, topic, collector.take, qos)
        return collector

    def wait_until(
        self, condition: Callable[[], object], what: object, timeout_s: float = WAIT_TIMEOUT_S
    ) -> object:
        """Poll a condition of the ROS graph until it is true; return its value.

        `what` says in a failure what was waited for.
        """
        deadline = time.monotonic() + timeout_s
        while True:
            value = condition()
            if value:
                return value
            if time.monotonic() > deadline:
                pytest.fail(f"not within {timeout_s} s: {what}")
            self._stop.wait(0.02)

    def publisher(self, message_type: type, topic: str, qos: object = 10, matches: int = 1):
        """Return a publisher that subscriptions have matched, ready for a single message."""
        publisher = self.node.create_publisher(message_type, topic, qos)
        self.wait_until(
            lambda: publisher.get_subscription_count() >= matches,
            f"{matches} subscriptions on {topic}",
        )
        self.be_known_to_readers(publisher.topic_name)
        return publisher

    def call(self, service_type: type, name: str, request: object, timeout_s: float = 30.0):
        """Call a service once it is available; return its answer."""
        return self.result_of(self.ask(service_type, name, request, timeout_s), name, timeout_s)

    def ask(self, service_type: type, name: str, request: object, timeout_s: float = 30.0):
        """Call a service once it is available; return the future of its answer.

        It must be discovered only once: the next call of the service has the same client.
        """
        client = self._callers.get((service_type, name))
        if client is None:
            client = self.node.create_client(service_type, name)
            self._callers[service_type, name] = client
        if not client.wait_for_service(timeout_sec=timeout_s):
            pytest.fail(f"no service {name} within {timeout_s} s")
        ends = self._ends_of(client)
        if ends != self._known.get(client):
            self.be_known_to_server(client.service_name)
            self._known[client] = ends
        return client.call_async(request)

    def set_parameters(self, node: str, **values: object) -> str:
        """Set parameters of a node, all or none; '__' in a name stands for a dot.

        Returns:
            why they were refused, "" if they are set.
        """
        named = [Parameter(name.replace("__", "."), value=v) for name, v in values.items()]
        request = Service.Request(parameters=[each.to_parameter_msg() for each in named])
        result = self.call(Service, f"{node}/set_parameters_atomically", request).result
        assert result.successful == (not result.reason), result
        return result.reason

    def get_parameter(self, node: str, name: str) -> Any:
        """Return a parameter of a node, None where it has no such one."""
        request = GetParameters.Request(names=[name])
        (message,) = self.call(GetParameters, f"{node}/get_parameters", request).values
        value = parameter_value_to_python(message)
        return value.tolist() if isinstance(value, array) else value

    def _ends_of(self, client: Any) -> set[object]:
        """Return all that a service's server must have discovered, and what that server is."""
        topic, node = f"rq{client.service_name}Request", self.node
        servers = node.get_subscriptions_info_by_topic(topic, True)
        own = (*node.publishers, *node.subscriptions, *node.clients, *node.services)
        return {*map(id, own), *(bytes(server.endpoint_gid) for server in servers)}

    def action(self, action_type: type, name: str, timeout_s: float = WAIT_TIMEOUT_S) -> Any:
        """Return a client of an action whose server has discovered all of it."""
        made = self.run(lambda: ActionClient(self.node, action_type, name), name)
        self._actions.append(made)
        self.wait_until(made.server_is_ready, f"the action {name}", timeout_s)
        self.be_known_to_server(f"{name}/_action/send_goal")
        return made

    def send_goal(self, action: Any, goal: object, take_feedback: Any = None) -> Any:
        """Send a goal; return the future of its result, None where it is rejected.

        On the executor's thread: rclpy notes a request only after it has sent it, and what is
        answered before that is thrown away.
        """

        async def send() -> Any:
            handle = await action.send_goal_async(goal, take_feedback)
            return handle.get_result_async() if handle.accepted else None

        return self.run(send, "the answer to a goal")

    def be_known_to_readers(self, topic: str) -> None:
        """Block until the readers of a topic have discovered all endpoints of this node."""
        self._complete(DiscoveryCheck(self.node, topic))

    def be_known_to_server(self, service: str) -> None:
        """Block until a service's server has discovered all endpoints of this node."""
        self._complete(DiscoveryCheck.with_server(self.node, service))

    def _complete(self, check: Any) -> None:
        self.wait_until(lambda: check.complete, check)
        self.run(check.close, "the end of a check of discovery")

    def run(self, function: Callable[[], object], what: str) -> Any:
        """Run a function on the executor's thread; return its result."""
        return self.result_of(self.executor.create_task(function), what)

    @contextmanager
    def tidied(self) -> "Iterator[Client]":
        """Destroy in the end what the node has been given within this block."""
        kinds = {
            "timers": self.node.destroy_timer,
            "clients": self.node.destroy_client,
            "services": self.node.destroy_service,
            "publishers": self.node.destroy_publisher,
            "subscriptions": self.node.destroy_subscription,
        }
        before = {kind: list(getattr(self.node, kind)) for kind in kinds}
        yield self

        def destroy_new() -> None:
            for service, caller in list(self._callers.items()):
                if caller not in before["clients"]:
                    del self._callers[service]
            for kind, destroy in kinds.items():
                for each in list(getattr(self.node, kind)):
                    if each not in before[kind]:
                        destroy(each)

        self.run(destroy_new, "the node's end points")

    @staticmethod
    def collector() -> Collector:
        """Return a callback that collects messages."""
        return Collector()

    @staticmethod
    def result_of(future: Any, what: str, timeout_s: float = WAIT_TIMEOUT_S) -> Any:
        """Block until the executor has completed a future; return its result."""
        done = threading.Event()
        future.add_done_callback(lambda _: done.set())
        if not done.wait(timeout_s):
            pytest.fail(f"no answer from {what} within {timeout_s} s")
        return future.result()

    def close(self) -> None:
        """End the executor, then the node, then the context."""
        self._stop.set()
        self._thread.join(60.0)
        for action in self._actions:
            action.destroy()
        self.executor.shutdown()
        self.node.destroy_node()
        self.context.try_shutdown()


@pytest.fixture
def client() -> Iterator[Client]:
    """Return a default rclpy client in this process."""
    connected = Client()
    yield connected
    connected.close()


@pytest.fixture(scope="module")
def client_for_file() -> Iterator[Client]:
    """Return a default rclpy client that serves all tests of a file."""
    connected = Client()
    yield connected
    connected.close()


@pytest.fixture(scope="session")
def latched() -> Any:
    """Return the QoS of a topic whose last message late subscribers get."""
    return QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


@pytest.fixture
def client_in() -> Iterator[Callable[[int], Client]]:
    """Return a function that makes a client in a ROS domain."""
    made: list[Client] = []

    def make(domain: int) -> Client:
        made.append(Client(domain))
        return made[-1]

    yield make
    for each in made:
        each.close()
