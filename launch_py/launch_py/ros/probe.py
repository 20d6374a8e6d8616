"""The probe process: watches topics, services, actions and web pages for the supervisor.

Reads one JSON object a line from standard input: an id, the kind of the condition (the class name
in `launch_py.readiness`) and its fields, or "Forget". Writes {"id": n} when condition n is met,
{"id": n, "error": text} when it can never be. Ends with its standard input.
"""

from __future__ import annotations

import importlib
import json
import queue
import sys
import threading
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from launch_py.library_output import library_output_on_stderr

if TYPE_CHECKING:
    from rclpy.node import Node

POLL_S = 0.02
HTTP_POLL_S = 0.1
HTTP_TIMEOUT_S = 2.0

Check = Callable[[], bool]


class ProbeError(Exception):
    """A condition that cannot be watched."""


class RosGraph:
    """What the ROS graph looks like from one node; belongs to the main thread."""

    def __init__(self) -> None:
        import rclpy
        from rclpy.executors import SingleThreadedExecutor
        from rclpy.signals import SignalHandlerOptions

        rclpy.init(args=[], signal_handler_options=SignalHandlerOptions.NO)
        self._node: Node = rclpy.create_node(
            "launch_probe",
            use_global_arguments=False,
            enable_rosout=False,
            start_parameter_services=False,
        )
        self._executor = SingleThreadedExecutor()
        self._executor.add_node(self._node)
        self._received: set[str] = set()
        self._subscribed: set[str] = set()

    def spin(self, timeout_s: float) -> None:
        """Take what has come in."""
        self._executor.spin_once(timeout_sec=timeout_s)

    def close(self) -> None:
        """Leave the graph."""
        from rclpy.utilities import try_shutdown

        self._executor.shutdown()
        self._node.destroy_node()
        try_shutdown()

    def has_topic(self, topic: str, type_name: str | None, first_message: bool) -> bool:
        """Return whether the topic has a publisher, or has brought a message."""
        publishers = self._node.get_publishers_info_by_topic(topic)
        offered = [p for p in publishers if type_name in (None, p.topic_type)]
        if not offered or not first_message:
            return bool(offered)
        if topic not in self._subscribed:
            self._subscribe(topic, offered[0].topic_type, offered[0].qos_profile)
        return topic in self._received

    def has_service(self, name: str) -> bool:
        """Return whether the service has a server."""
        return self._node.count_services(name) > 0

    def _subscribe(self, topic: str, type_name: str, offered: Any) -> None:
        from rclpy.qos import QoSProfile

        package, _, name = type_name.partition("/msg/")
        try:
            message_type = getattr(importlib.import_module(f"{package}.msg"), name)
        except (ImportError, AttributeError) as error:
            raise ProbeError(f"message type {type_name} of {topic} is not installed") from error
        # What the publisher offers always matches, and brings a latched message, too.
        profile = QoSProfile(
            depth=1, reliability=offered.reliability, durability=offered.durability
        )
        self._node.create_subscription(
            message_type, topic, lambda _: self._received.add(topic), profile, raw=True
        )
        self._subscribed.add(topic)


class Probe:
    """Holds the open conditions; `run` is the whole life of the process."""

    def __init__(self, answer: Callable[[Mapping[str, Any]], None]) -> None:
        self._answer = answer
        self._checks: dict[int, Check] = {}
        self._graph: RosGraph | None = None

    def run(self, messages: queue.SimpleQueue[dict[str, Any] | None]) -> None:
        """Watch conditions as they come until None comes."""
        try:
            while True:
                message = self._next_message(messages)
                if message is None:
                    return
                if message:
                    self._take(message)
                self._check_all()
        finally:
            if self._graph is not None:
                self._graph.close()

    def _next_message(
        self, messages: queue.SimpleQueue[dict[str, Any] | None]
    ) -> dict[str, Any] | None:
        """Return the next message, {} where none has come in time; block while there is nothing."""
        if self._graph is not None and self._checks:
            self._graph.spin(POLL_S)
        try:
            if not self._checks:
                return messages.get()
            return messages.get(timeout=0.0 if self._graph else POLL_S)
        except queue.Empty:
            return {}

    def _take(self, message: dict[str, Any]) -> None:
        number, kind = message["id"], message["kind"]
        if kind == "Forget":
            self._checks.pop(number, None)
            return
        try:
            self._checks[number] = self._make_check(kind, message)
        except (ImportError, ProbeError) as error:
            self._answer({"id": number, "error": f"cannot watch a {kind} condition: {error}"})

    def _make_check(self, kind: str, message: dict[str, Any]) -> Check:
        if kind == "HttpOk":
            return HttpCheck(message["url"])
        if self._graph is None:
            self._graph = RosGraph()
        graph = self._graph
        match kind:
            case "TopicPublished":
                return lambda: graph.has_topic(
                    message["topic"], message["type"], message["first_message"]
                )
            case "ServiceAvailable":
                return lambda: graph.has_service(message["service"])
            case "ActionAvailable":
                return lambda: graph.has_service(f"{message['action']}/_action/send_goal")
        raise ProbeError("there is no such condition")

    def _check_all(self) -> None:
        for number, check in list(self._checks.items()):
            try:
                if not check():
                    continue
                self._answer({"id": number})
            except ProbeError as error:
                self._answer({"id": number, "error": str(error)})
            self._checks.pop(number, None)


class HttpCheck:
    """Whether a GET of a URL answers 200; asks from a thread of its own."""

    def __init__(self, url: str) -> None:
        self._url = url
        self._met = threading.Event()
        threading.Thread(target=self._ask, daemon=True).start()

    def __call__(self) -> bool:
        """Return whether it has answered 200."""
        return self._met.is_set()

    def _ask(self) -> None:
        import urllib.request

        pause = threading.Event()
        while True:
            try:
                with urllib.request.urlopen(self._url, timeout=HTTP_TIMEOUT_S) as response:
                    if response.status == 200:
                        self._met.set()
                        return
            except (OSError, ValueError):
                pass  # Nobody listens yet, or the answer is not the one we wait for.
            pause.wait(HTTP_POLL_S)


def main() -> None:
    """Run until standard input ends."""
    messages: queue.SimpleQueue[dict[str, Any] | None] = queue.SimpleQueue()

    def read() -> None:
        for line in sys.stdin:
            messages.put(json.loads(line))
        messages.put(None)

    def answer(message: Mapping[str, Any]) -> None:
        sys.stdout.write(json.dumps(message) + "\n")
        sys.stdout.flush()

    threading.Thread(target=read, daemon=True).start()
    with library_output_on_stderr():
        Probe(answer).run(messages)
