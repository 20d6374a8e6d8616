"""A node of the test's process: publishes, listens and calls while an executor spins it."""

import threading
import time
from collections.abc import Callable
from importlib import import_module
from typing import Any, Generic, TypeVar

import rclpy
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions

from arm_node.executor_thread import ExecutorThread
from arm_node.testing import DiscoveryCheck
from arm_node.workarounds.discovery import first_node
from arm_sim.errors import BenchError

WAIT_S = 30.0
"""Wall time to wait for anything that should arrive at once."""
POLL_S = 0.01

MessageT = TypeVar("MessageT")
ResultT = TypeVar("ResultT")


class Messages(Generic[MessageT]):
    """The messages of a topic since the subscription began. Any thread.

    Attributes:
        topic: the topic's name.
    """

    def __init__(self, topic: str) -> None:
        self.topic = topic
        self._received: list[MessageT] = []
        self._changed = threading.Condition()

    def take(self, message: MessageT) -> None:
        """Add a message; the executor's thread."""
        with self._changed:
            self._received.append(message)
            self._changed.notify_all()

    @property
    def received(self) -> list[MessageT]:
        """The messages so far, the oldest first."""
        with self._changed:
            return list(self._received)

    def wait_until(
        self,
        condition: Callable[[list[MessageT]], bool],
        what: str = "certain messages",
        timeout_s: float = WAIT_S,
    ) -> list[MessageT]:
        """Return the messages as soon as a condition holds for them.

        Args:
            condition: is given all messages so far.
            what: what the condition waits for, for the error message.
            timeout_s: wall time to wait at most.

        Raises:
            BenchError: the condition does not hold in time.
        """
        deadline = time.monotonic() + timeout_s
        with self._changed:
            while not condition(self._received):
                left_s = deadline - time.monotonic()
                if left_s <= 0:
                    last = self._received[-1] if self._received else "none"
                    raise BenchError(
                        f"timed out after {timeout_s:g} s, waiting for {what} on {self.topic}; "
                        f"{len(self._received)} messages, the last: {last}"
                    )
                self._changed.wait(left_s)
            return list(self._received)

    def wait_for(self, count: int = 1, timeout_s: float = WAIT_S) -> list[MessageT]:
        """Return the messages as soon as there are this many; see `wait_until`."""
        return self.wait_until(lambda m: len(m) >= count, f"{count} messages", timeout_s)


class RosConnection:
    """A participant in one ROS domain, for one test. The test's thread.

    Attributes:
        node: the node, for what this class does not offer; an executor spins it.
    """

    def __init__(self, domain_id: int) -> None:
        self._context = Context()
        rclpy.init(
            context=self._context,
            domain_id=domain_id,
            signal_handler_options=SignalHandlerOptions.NO,
        )
        self.node = first_node(lambda: Node("test", context=self._context))
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self.node)
        self._thread = ExecutorThread("node of the test", self._executor)
        self._publishers: dict[str, Any] = {}
        self._thread.start()

    def close(self) -> None:
        """End the executor, then the node, then the participant."""
        self._thread.stop()
        self.node.destroy_node()
        self._context.try_shutdown()

    def run(self, function: Callable[[], ResultT], what: str) -> ResultT:
        """Run a function on the executor's thread; return its result."""
        return self.result_of(self._executor.create_task(function), what)

    def result_of(self, future: Any, what: str, timeout_s: float = WAIT_S) -> Any:
        """Return the result of a future.

        Raises:
            BenchError: there is no result in time.
        """
        done = threading.Event()
        future.add_done_callback(lambda _: done.set())
        if not done.wait(timeout_s):
            raise BenchError(f"no answer from {what} within {timeout_s:g} s")
        return future.result()

    def wait_until(
        self, condition: Callable[[], object], what: str, timeout_s: float = WAIT_S
    ) -> None:
        """Poll a condition of the ROS graph until it holds.

        Raises:
            BenchError: it does not hold in time.
        """
        deadline = time.monotonic() + timeout_s
        while not condition():
            if time.monotonic() > deadline:
                raise BenchError(f"timed out after {timeout_s:g} s, waiting for {what}")
            time.sleep(POLL_S)

    def collect(
        self, topic: str, message_type: type[MessageT], qos: Any = 10
    ) -> Messages[MessageT]:
        """Collect a topic's messages from now on."""
        messages: Messages[MessageT] = Messages(topic)
        self.run(
            lambda: self.node.create_subscription(message_type, topic, messages.take, qos), topic
        )
        return messages

    def type_of(self, topic: str) -> Any:
        """Return the class of a topic's messages.

        Raises:
            BenchError: there is no such topic.
        """
        name = self.node.resolve_topic_name(topic)
        types = dict[str, Any]()

        def is_known() -> bool:
            types.update(self.node.get_topic_names_and_types())
            return name in types

        self.wait_until(is_known, f"the topic {name}")
        package, _, message = types[name][0].split("/")
        return getattr(import_module(f"{package}.msg"), message)

    def publish(self, topic: str, message: Any, qos: Any = 10) -> None:
        """Publish a message; the first time, wait until the subscribers have been discovered.

        Raises:
            BenchError: nobody listens to the topic.
        """
        publisher = self._publishers.get(topic)
        if publisher is None:
            publisher = self.run(
                lambda: self.node.create_publisher(type(message), topic, qos), topic
            )
            self.wait_until(publisher.get_subscription_count, f"a subscription of {topic}")
            self._be_known(DiscoveryCheck(self.node, publisher.topic_name), topic)
            self._publishers[topic] = publisher
        publisher.publish(message)

    def call(
        self, name: str, service_type: Any, request: Any = None, timeout_s: float = WAIT_S
    ) -> Any:
        """Call a service as soon as there is one; return its answer.

        Args:
            name: of the service.
            service_type: its class.
            request: the request; None for one with default values.
            timeout_s: wall time to wait for the service, and again for its answer.

        Raises:
            BenchError: there is no such service, or it does not answer in time.
        """
        client = self.run(lambda: self.node.create_client(service_type, name), name)
        try:
            self.wait_until(client.service_is_ready, f"the service {name}", timeout_s)
            self._be_known(DiscoveryCheck.with_server(self.node, client.service_name), name)
            asked = client.call_async(request or service_type.Request())
            return self.result_of(asked, name, timeout_s)
        finally:
            self.run(lambda: self.node.destroy_client(client), name)

    def act(self, name: str, action_type: Any, goal: Any, timeout_s: float) -> Any:
        """Send a goal and wait for its end; return the wrapped result with its status.

        Returns:
            None if the goal was rejected.

        Raises:
            BenchError: there is no such action, or the goal does not end in time.
        """
        from rclpy.action.client import ActionClient

        client = self.run(lambda: ActionClient(self.node, action_type, name), name)
        try:
            self.wait_until(client.server_is_ready, f"the action {name}")
            self._be_known(DiscoveryCheck.with_server(self.node, f"{name}/_action/send_goal"), name)

            async def send() -> Any:
                handle: Any = await client.send_goal_async(goal)
                return await handle.get_result_async() if handle.accepted else None

            return self.result_of(self._executor.create_task(send), name, timeout_s)
        finally:
            self.run(client.destroy, name)

    def _be_known(self, check: DiscoveryCheck, name: str) -> None:
        try:
            self.wait_until(lambda: check.complete, f"the discovery of this node by {name}")
        finally:
            self.run(check.close, name)
